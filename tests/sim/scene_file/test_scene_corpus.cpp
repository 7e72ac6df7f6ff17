// What the fuzzer found worth keeping, fed to its target again: inputs that together reach every branch of
// the scene's reader it knows.
#define LLVMFuzzerTestOneInput fuzz_scene
#include "tests/fuzz/scene_fuzz.cpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "base/whole_file.hpp"
#include "source_dir.hpp"

TEST_CASE("the scene loader bears its fuzzer's corpus", "[corpus]") {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(UNRAVEL_SOURCE_DIR "/tests/fuzz/scenes")) {
        const std::vector<std::uint8_t> bytes = read_whole_file(entry.path(), 1 << 20);
        INFO(entry.path());
        CHECK_NOTHROW(fuzz_scene(bytes.data(), bytes.size()));
        ++files;
    }
    CHECK(files > 20);
}
