// libFuzzer target of the frame records' reader. Any bytes have to end in a record that fits the cloth or in
// an InputError, and take no more memory than a few times the file. Head and checksum are put round the
// input: what they protect from is chance, not malice.
//
//   CXX=clang++ cmake -S . -B build/fuzz -G Ninja -DUNRAVEL_BUILD_FUZZ=ON
//   cmake --build build/fuzz --target record_fuzz
//   mkdir -p build/records && build/fuzz/record_fuzz build/records

#include <cstring>
#include <vector>

#include "base/file_errors.hpp"
#include "base/hash.hpp"
#include "sim/run/frame_record.hpp"

using namespace unravel;
using namespace unravel::sim;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint64_t scene = 7;
    constexpr std::size_t particles = 4, springs = 6;
    std::vector<std::uint8_t> bytes(8 + sizeof scene + size + sizeof(std::uint64_t));
    std::memcpy(bytes.data(), record_magic.data(), record_magic.size());
    std::memcpy(bytes.data() + 8, &scene, sizeof scene);
    if (size > 0) std::memcpy(bytes.data() + 16, data, size);
    const std::uint64_t sum = hash_bytes(bytes.data(), bytes.size() - sizeof sum);
    std::memcpy(bytes.data() + bytes.size() - sizeof sum, &sum, sizeof sum);
    try {
        const FrameRecord record = parse_record(bytes, "fuzz.state", scene, particles, springs);
        if (record.state.x.size() != particles || record.springs.size() != springs) std::abort();
    } catch (const InputError&) {
    }
    return 0;
}
