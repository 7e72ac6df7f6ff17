// libFuzzer target of the scene loader. Any bytes have to end in a scene or in a SceneError, never in another
// exception, an endless run or a sanitizer's finding; a scene that is accepted has to read back to itself.
// The input's lines that start with "--set " are options, the rest is the file.
//
//   CXX=clang++ cmake -S . -B build/fuzz -G Ninja -DUNRAVEL_BUILD_FUZZ=ON
//   cmake --build build/fuzz --target scene_fuzz
//   mkdir -p build/corpus && build/fuzz/scene_fuzz build/corpus tests/scenes_bad tests/scenes scenes

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string input(reinterpret_cast<const char*>(data), size);
    std::string text;
    std::vector<std::string> options;
    for (std::size_t at = 0; at < input.size();) {
        const std::size_t end = std::min(input.find('\n', at), input.size());
        const std::string line = input.substr(at, end - at);
        if (line.starts_with("--set "))
            options.push_back(line.substr(6));
        else
            text += line + '\n';
        at = end + 1;
    }
    std::string written;
    try {
        written = scene_to_toml(parse_scene(text, "fuzz.toml", "/nonexistent", options));
    } catch (const SceneError&) {
        return 0;
    }
    // From here on an exception is a finding.
    const std::string again = scene_to_toml(parse_scene(written, "fuzz.toml", "/nonexistent"));
    if (written != again) {
        std::fprintf(stderr, "%s\n---- reads back as\n%s\n", written.c_str(), again.c_str());
        std::abort();
    }
    return 0;
}
