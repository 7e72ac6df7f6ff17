// Frames that cannot be used are told apart: each needs another thing done.

#include "tool/folder/run_folder.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cstring>

#include "base/whole_file.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene_file/load.hpp"
#include "tests/base/temporary_folder.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

// No more of a record than tells its format and its scene.
void write_head(const std::filesystem::path& file, char format, std::uint64_t scene_hash) {
    std::string head(record_magic);
    head.back() = format;
    head.append(reinterpret_cast<const char*>(&scene_hash), sizeof scene_hash);
    write_whole_file(file, std::string_view(head + std::string(64, '\0')));
}

}  // namespace

TEST_CASE("a frame that cannot be used is explained", "[run]") {
    const TemporaryFolder runs;
    const Scene scene = parse_scene("[cloth]\nparticles = [3, 3]\n", "scene.toml", runs.path());
    const RunFolder folder{runs.path() / "run"};
    const std::uint64_t hash = open_run(folder, scene, Existing::refuse);
    const std::filesystem::path file = folder.record(0);
    using Catch::Contains;

    CHECK_THAT(why_unusable(folder, 0, hash), Contains("there is no frame 0") && Contains("--resume"));

    const char older = static_cast<char>(record_magic.back() - 1);
    write_head(file, older, hash);
    CHECK_THAT(why_unusable(folder, 0, hash),
               Contains(fmt::format("format {}, by unravel of a version that is not known", int{older})) &&
                   Contains("--force"));
    write_whole_file(folder.run_json(), std::string_view(R"({"version": "0.0.7"})"));
    CHECK_THAT(why_unusable(folder, 0, hash), Contains("by unravel 0.0.7"));

    write_head(file, record_magic.back(), hash + 1);
    CHECK_THAT(why_unusable(folder, 0, hash), Contains("of another scene") && Contains("0.0.7"));
    // The scene asked for is not the run's, and the frames are the run's.
    write_head(file, record_magic.back(), hash);
    CHECK_THAT(why_unusable(folder, 0, hash + 1), Contains("--set"));
    CHECK_THAT(why_unusable(folder, 0, hash), Contains("is damaged"));
    write_whole_file(file, std::string_view("?"));
    CHECK_THAT(why_unusable(folder, 0, hash), Contains("is damaged"));
}
