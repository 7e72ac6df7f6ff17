// A mesh and a grid of the same cloth are the same springs, masses and air cells, and behave alike.

#include <catch2/catch.hpp>
#include <map>
#include <numeric>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/model/mesh_bends.hpp"
#include "sim/run/simulate.hpp"
#include "tests/sim/mesh/mesh_scene.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

const std::string material =
    "[cloth.material]\nstretch = [200, 90]\nstretch_damping = [0.02, 0.01]\nshear = 5\nbend = 1e-5\n";

template <typename Springs>
std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, double>> table(
    const Springs& springs) {
    std::multimap<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, double>> out;
    for (std::size_t s = 0; s < springs.size(); ++s)
        out.insert({{springs.i[s], springs.j[s]}, {springs.rest[s], springs.stiffness[s]}});
    return out;
}

template <typename Springs>
void require_same(const Springs& a, const Springs& b) {
    const auto first = table(a), second = table(b);
    REQUIRE(first.size() == second.size());
    for (auto p = first.begin(), q = second.begin(); p != first.end(); ++p, ++q) {
        REQUIRE(p->first == q->first);
        REQUIRE(p->second.first == Approx(q->second.first).epsilon(1e-9));
        REQUIRE(p->second.second == Approx(q->second.second).epsilon(1e-9));
    }
}

ClothModel model_of(const Scene& scene) {
    Placement placement;
    return build_model(scene, placement);
}

}  // namespace

TEST_CASE("a grid as a mesh, of quads or of triangles, is the same model", "[mesh]") {
    const int n = 7;
    const ClothModel grid =
        model_of(parse_scene("[cloth]\nparticles = [8, 8]\n[wind]\n" + material, "grid.toml"));
    for (const bool triangles : {false, true}) {
        INFO(triangles);
        const testing::MeshScene made("[cloth]\nmesh = \"mesh.obj\"\n[wind]\n" + material,
                                      testing::sheet_obj(n, triangles));
        const ClothModel mesh = model_of(made.scene);
        REQUIRE(mesh.size() == grid.size());
        for (std::size_t p = 0; p < grid.size(); ++p)
            REQUIRE(mesh.mass[p] == Approx(grid.mass[p]).epsilon(1e-12));
        CHECK(mesh.springs.stretch_count == grid.springs.stretch_count);
        require_same(mesh.springs, grid.springs);
        require_same(mesh.bends, grid.bends);
        REQUIRE(mesh.curvature.size() == grid.curvature.size());
        const auto curvature = [](const ClothModel& model) {
            std::map<std::vector<std::uint32_t>, double> out;
            for (std::size_t s = 0; s < model.curvature.size(); ++s) {
                const auto& p = model.curvature.p[s];
                std::vector<std::uint32_t> particles(p.begin(), p.begin() + model.curvature.count(s));
                std::ranges::sort(particles);
                out[particles] = model.curvature.stiffness[s];
            }
            return out;
        };
        for (const auto& [particles, stiffness] : curvature(grid))
            REQUIRE(curvature(mesh)[particles] == Approx(stiffness).epsilon(1e-6));
        CHECK(air_cells(mesh).corners.size() == air_cells(grid).corners.size());
    }
}

TEST_CASE("a hanging mesh sags as the grid does", "[mesh]") {
    const std::string rest =
        "[cloth.material]\nstretch = 50\nstretch_damping = 0.05\n[wind]\ndrag = 20\n"
        "[clip]\nfps = 10\n[solver]\nstep = \"1/100\"\n";
    const auto sag = [](const Scene& scene) {
        Simulation simulation = start_simulation(scene);
        for (int frame = 0; frame < 20; ++frame) next_record(simulation);
        double lowest = 0;
        for (const Vec3& x : simulation.state.x) lowest = std::min(lowest, x.y());
        return lowest;
    };
    // Upright: the file's square is turned so that its edge z = −1/2 is on top, and pinned there.
    const std::string grid =
        "[cloth]\nparticles = [11, 11]\nrotation = [90, 0, 0]\n[[cloth.pin]]\nedge = \"v0\"\n";
    const double reference = sag(parse_scene(grid + rest, "grid.toml"));
    CHECK(reference < -0.5);
    for (const bool triangles : {false, true}) {
        const testing::MeshScene made(
            "[cloth]\nmesh = \"mesh.obj\"\nrotation = [90, 0, 0]\n[[cloth.pin]]\n"
            "within = [-1, 0.499, -1, 1, 0.501, 1]\n" +
                rest,
            testing::sheet_obj(10, triangles));
        const double here = sag(made.scene);
        CHECK(here + 0.5 == Approx(reference + 0.5).epsilon(0.02));
    }
}

TEST_CASE("a sheet of equilateral triangles stretches and bends as its material says", "[mesh]") {
    // Rows of triangles of side a: none finds a partner.
    const int n = 24;
    const double a = 1.0 / n, height = a * std::sqrt(3.0) / 2;
    std::string obj;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) obj += fmt::format("v {} 0 {}\n", a * i + 0.5 * a * (j % 2), height * j);
    }
    const auto at = [&](int i, int j) { return j * (n + 1) + i + 1; };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            if (j % 2 == 0)
                obj += fmt::format("f {} {} {}\nf {} {} {}\n", at(i, j), at(i, j + 1), at(i + 1, j),
                                   at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
            else
                obj += fmt::format("f {} {} {}\nf {} {} {}\n", at(i, j), at(i, j + 1), at(i + 1, j + 1),
                                   at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    }
    const testing::MeshScene made(
        "[cloth]\nmesh = \"mesh.obj\"\nbend_model = \"buckling\"\n[cloth.material]\nstretch = 60\nbend = "
        "2e-5\n",
        obj);
    const ClothModel model = model_of(made.scene);
    const MeshCloth& mesh = *made.scene.cloths[0].geometry;
    CHECK(model.springs.size() == model.springs.stretch_count);
    // Away from the border every edge has k = E √3/2, of E = 8/9 of what it is held in its width …
    const double expected = 8.0 / 9 * 60 * std::sqrt(3.0) / 2;
    CHECK(std::ranges::max(model.springs.stiffness.values()) == Approx(expected).epsilon(1e-6));
    // … and a cylinder of any direction has the energy ½ B κ² per area: Σ k_b L cos⁴ = B · area.
    double area = 0;
    for (const MeshCloth::Cell& cell : mesh.cells) area += mesh.area(cell);
    for (const double direction : {0.0, 0.3, 0.9, 1.4}) {
        double sum = 0;
        for (std::size_t s = 0; s < model.bends.size(); ++s) {
            const Vec3 d = (mesh.rest[model.bends.j[s]] - mesh.rest[model.bends.i[s]]).normalized();
            const double along = d.x() * std::cos(direction) + d.z() * std::sin(direction);
            sum += model.bends.stiffness[s] * model.bends.rest[s] * std::pow(along, 4);
        }
        CHECK(sum == Approx(2e-5 * area).epsilon(0.08));  // the border has fewer
    }
}

TEST_CASE("seams close in their time and hold", "[mesh]") {
    // Two squares, a tenth of a metre apart, sewn along one side of each.
    std::string obj;
    for (const double z : {-0.05, 0.05}) {
        for (int j = 0; j <= 4; ++j) {
            for (int i = 0; i <= 4; ++i) obj += fmt::format("v {} {} {}\n", 0.1 * i, 0.1 * j, z);
        }
    }
    for (const int first : {1, 26}) {
        for (int j = 0; j < 4; ++j) {
            for (int i = 0; i < 4; ++i) {
                const int k = first + 5 * j + i;
                obj += fmt::format("f {} {} {} {}\n", k, k + 1, k + 6, k + 5);
            }
        }
    }
    for (int i = 0; i < 5; ++i) obj += fmt::format("l {} {}\n", 21 + i, 46 + i);
    for (const char* extra : {"", "[self_collision]\n"}) {
        INFO(extra);
        const testing::MeshScene made(
            "gravity = [0, 0, 0]\n[cloth]\nmesh = \"mesh.obj\"\nsewing = {time = 0.4}\n"
            "[wind]\n[clip]\nfps = 20\n" +
                std::string(extra),
            obj);
        Simulation simulation = start_simulation(made.scene);
        REQUIRE(simulation.model.stitches.size() == 5);
        const auto gap = [&] {
            double most = 0;
            for (std::size_t s = 0; s < 5; ++s)
                most = std::max(most, (simulation.state.x[simulation.model.stitches.i[s]] -
                                       simulation.state.x[simulation.model.stitches.j[s]])
                                          .norm());
            return most;
        };
        CHECK(gap() == Approx(0.1));
        for (int frame = 0; frame < 4; ++frame) next_record(simulation);
        CHECK(gap() < 0.07);
        for (int frame = 0; frame < 12; ++frame) next_record(simulation);
        CHECK(gap() < 0.005);
        // What is sewn is one part of the cloth to the solver.
        CHECK(simulation.ws.linear.components.count() >= 1);
    }
}
