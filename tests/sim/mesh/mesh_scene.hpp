#pragma once

// Scenes whose cloth is a mesh, made from text.

#include <fmt/format.h>

#include <string>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"
#include "tests/base/temporary_folder.hpp"

namespace unravel::testing {

using namespace sim;

/// n × n quads over a square of one metre in the x–z plane, as an OBJ; `triangles`: each cut in two.
inline std::string sheet_obj(int n, bool triangles = false) {
    std::string out;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
            const double u = double(i) / n, v = double(j) / n;
            out += fmt::format("v {} 0 {}\nvt {} {}\n", u - 0.5, v - 0.5, u, v);
        }
    }
    const auto at = [&](int i, int j) {
        const int k = j * (n + 1) + i + 1;
        return fmt::format("{}/{}", k, k);
    };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            const auto a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
            if (!triangles) {
                out += fmt::format("f {} {} {} {}\n", a, b, c, d);
            } else if ((i + 2 * j) % 3 == 0) {
                out += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d);
            } else {
                out += fmt::format("f {} {} {}\nf {} {} {}\n", a, b, d, b, c, d);
            }
        }
    }
    return out;
}

/// A scene in a folder of its own, with one mesh beside it.
struct MeshScene {
    TemporaryFolder folder;
    Scene scene;
    MeshScene(const std::string& toml, const std::string& obj) {
        write_whole_file(folder.path() / "mesh.obj", std::string_view(obj));
        scene = parse_scene(toml, "scene.toml", folder.path());
    }
};

}  // namespace unravel::testing
