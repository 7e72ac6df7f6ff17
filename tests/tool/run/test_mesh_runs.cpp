// A run is tied to the content of its meshes, and carries its own copies of them.

#include <catch2/catch.hpp>

#include "base/whole_file.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/scene_file/load.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"
#include "tool/folder/run_folder.hpp"

using namespace unravel;
using namespace unravel::tool;

TEST_CASE("a run with meshes can be moved, and is not gone on with once a mesh has changed", "[mesh][run]") {
    const std::string toml = "[cloth]\nname = \"shirt\"\nmesh = \"mesh.obj\"\n";
    const testing::MeshScene made(toml, testing::sheet_obj(3));
    const TemporaryFolder runs;
    const RunFolder folder{runs.path() / "run"};
    const std::uint64_t hash = open_run(folder, made.scene, Existing::refuse, made.folder.path());

    // The folder alone is enough.
    const Scene own = load_scene(folder.scene());
    CHECK(scene_hash(own) == hash);
    CHECK(own.cloths[0].geometry->rest == made.scene.cloths[0].geometry->rest);
    CHECK(open_run(folder, made.scene, Existing::resume, made.folder.path()) == hash);

    const testing::MeshScene changed(toml, testing::sheet_obj(4));
    CHECK(scene_hash(changed.scene) != hash);
    CHECK_THROWS_WITH(open_run(folder, changed.scene, Existing::resume, changed.folder.path()),
                      Catch::Contains("the mesh \"mesh.obj\" of shirt has changed since"));
    // Refused before anything was touched.
    CHECK(scene_hash(load_scene(folder.scene())) == hash);

    // A copy that is no longer what the run was made with is told from one that is.
    write_whole_file(folder.root / "mesh.obj", std::string_view(testing::sheet_obj(5)));
    CHECK_THROWS_WITH(load_scene(folder.scene()), Catch::Contains("the mesh \"mesh.obj\" has changed"));
}
