#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/study/verify/theory.hpp"
#include "tool/study/verify/verify_cases.hpp"
#include "tool/study/verify/verify_run.hpp"

namespace unravel::tool {

namespace {

constexpr double stretch_u = 400, stretch_v = 250, shear = 3, small = 1e-3;
// Of triangles: their edges run in all directions, and blur what differs along two.
constexpr double stretch_even = 300;

std::string sheet_of(std::array<int, 2> grid, double along_u = stretch_u, double along_v = stretch_v) {
    return fmt::format(
        "gravity = [0, 0, 0]\n[cloth]\nparticles = [{}, {}]\nsize = [1, 1]\nmaterial = {{ stretch = [{}, "
        "{}], "
        "shear = {}, bend = 0 }}\n",
        grid[0], grid[1], along_u, along_v, shear);
}

// Rows of equilateral triangles of side a, between two straight borders.
PolygonMesh triangles(int rows) {
    PolygonMesh mesh;
    mesh.parts.emplace_back();
    const double height = 1.0 / rows, side = height * 2 / std::sqrt(3.0);
    const auto columns = static_cast<int>(std::round(1 / side));
    for (int j = 0; j <= rows; ++j) {
        for (int i = 0; i <= columns; ++i) {
            const double x = side * (i + 0.5 * (j % 2));
            mesh.positions.emplace_back(x, 0, height * j);
            mesh.uvs.emplace_back(x, height * j);
        }
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::array<std::uint32_t, 4> corners{a, b, c, 0};
        mesh.add_face({3, corners, corners}, 0, static_cast<std::uint32_t>(mesh.faces.size()), 0);
    };
    for (int j = 0; j < rows; ++j) {
        const int odd = j % 2;
        for (int i = 0; i < columns; ++i) {
            add(at(i, j), at(i + odd, j + 1), at(i + 1, j));
            add(at(i + 1 - odd, j), at(i, j + 1), at(i + 1, j + 1));
        }
    }
    finish_numbering(mesh);
    return mesh;
}

Simulation triangle_simulation(int rows) {
    Scene scene = parse_scene(sheet_of({2, 2}, stretch_even, stretch_even), "verify.toml");
    Cloth& cloth = scene.cloths[0];
    cloth.geometry = std::make_shared<MeshCloth>(make_mesh_cloth(triangles(rows), 1.0, UpAxis::y));
    cloth.particles = {static_cast<int>(cloth.geometry->rest.size()), 1};
    return start_simulation(scene);
}

double area_of(const Simulation& simulation) {
    double mass = 0;
    for (const double m : simulation.model.mass) mass += m;
    return mass / 0.2;
}

// Energy per area of an even deformation of the sheet's plane.
double energy_of(Simulation& simulation, const Eigen::Matrix2d& F) {
    const std::vector<Vec3> flat = simulation.state.x;
    for (Vec3& x : simulation.state.x) {
        const Vec2 moved = F * Vec2(x.x(), x.z());
        x = {moved.x(), x.y(), moved.y()};
    }
    const double energy = spring_energy(simulation);
    simulation.state.x = flat;
    return energy / area_of(simulation);
}

// A tape that hangs between two points, or is pulled between them.
std::string tape(int cells, double steps, const std::string& cloth, const std::string& rest) {
    return fmt::format(
        "[clip]\nduration = 8\nfps = 10\n[cloth]\nparticles = [{}, 2]\nsize = [1, 0.02]\ndensity = 0.2\n{}"
        "[[cloth.pin]]\nedge = \"u0\"\n[solver]\nstep = \"1/{}\"\n{}",
        cells + 1, cloth, steps, rest);
}

double lowest_of(const Simulation& simulation) {
    double lowest = 0;
    for (const Vec3& x : simulation.state.x) lowest = std::min(lowest, x.y());
    return lowest;
}

}  // namespace

VerifyCase::Result verify_moduli(bool) {
    VerifyCase::Result result;
    struct Sheet {
        const char* name;
        std::array<int, 2> grid;  // {rows, 0}: triangles
    };
    const auto measure_on = [&](const Sheet& sheet) {
        const bool triangular = sheet.grid[1] == 0;
        Simulation simulation =
            triangular ? triangle_simulation(sheet.grid[0]) : verify_simulation(sheet_of(sheet.grid));
        const auto add = [&](const char* what, double expected, double measured, double tolerance) {
            result.lines.push_back({what, sheet.name, 0, expected, measured, "", tolerance * expected});
        };
        const double per = 2 / (small * small);
        const auto modulus = [&](double uu, double vv, double uv) {
            Eigen::Matrix2d F;
            F << 1 + uu, uv, uv, 1 + vv;
            return per * energy_of(simulation, F);
        };
        // The border of triangles is half of what it stands for.
        const double tolerance = triangular ? 0.05 : 0.01;
        const double u = triangular ? stretch_even : stretch_u, v = triangular ? stretch_even : stretch_v;
        const double across = triangular ? stretch_even / 3 : 2 * shear;
        add("held width, along u", u, modulus(small, 0, 0), tolerance);
        add("held width, along v", v, modulus(0, small, 0), tolerance);
        add("both ways alike, mean", 0.5 * (u + v) + across, 0.5 * modulus(small, small, 0), tolerance);
        if (!triangular) add("shear", shear, modulus(0, 0, 0.5 * small), tolerance);
    };
    measure_on({"square cells", {11, 11}});
    measure_on({"square cells, fine", {41, 41}});
    measure_on({"cells of 2 : 1", {11, 21}});
    measure_on({"cells of 1 : 4", {41, 11}});
    measure_on({"triangles", {40, 0}});
    return result;
}

VerifyCase::Result verify_strip(bool fast) {
    VerifyCase::Result result;
    const auto measure = [](std::array<int, 2> grid, double steps) {
        Simulation simulation = verify_simulation(fmt::format(
            "[clip]\nduration = 8\nfps = 10\n[cloth]\nparticles = [{}, {}]\nsize = [0.05, 1]\nrotation = "
            "[90, 0, "
            "0]\ndensity = 0.2\nmaterial = {{ stretch = 100, shear = 4, bend = 0, stretch_damping = 2, "
            "shear_damping = 0.08 }}\n[[cloth.pin]]\nedge = \"v0\"\n[solver]\nstep = \"1/{}\"\n",
            grid[0], grid[1], steps));
        const double start = lowest_of(simulation);
        run_until(simulation, 3.0);
        return 1000 * (start - lowest_of(simulation));
    };
    // Cells of 1 : 1, 1 : 1 and, across and along, 1 : 2. It hangs along v: here b is along it.
    for (const auto& [grid, square] : {std::pair(std::array{3, 41}, 1.0), std::pair(std::array{5, 81}, 1.0),
                                       std::pair(std::array{5, 41}, 4.0)}) {
        const double modulus = 100 - 2 * 4 * square;
        add_lines({{grid}, common_steps}, fast, fmt::format("(b/a)² = {}", square),
                  1000 * 0.2 * gravity / (2 * modulus), 0.05, measure, result.lines);
        if (fast) break;
    }
    return result;
}

VerifyCase::Result verify_catenary(bool fast) {
    VerifyCase::Result result;
    const auto measure = [](std::array<int, 2> grid, double steps) {
        Simulation simulation = verify_simulation(tape(
            grid[0] - 1, steps,
            "material = { stretch = 5000, shear = 0, bend = 0, stretch_damping = 0.5 }\n[[cloth.pin]]\nedge "
            "= \"u1\"\nmotion = [ { time = 0 }, { time = 1, position = [-0.2, 0, 0] } ]\n",
            "[wind]\ndrag = 20\n"));
        run_until(simulation, 6.0);
        return -1000 * lowest_of(simulation);
    };
    add_lines({{{21, 2}, {41, 2}, {81, 2}}, common_steps}, fast, "", 1000 * catenary_sag(1.0, 0.8), 0.01,
              measure, result.lines);
    return result;
}

VerifyCase::Result verify_wave(bool fast) {
    VerifyCase::Result result;
    // Stretched by a tenth, the tape is let go level: its middle is lowest when the waves from its ends have
    // crossed it, L/c later.
    const double length = 1.1, tension = 100 * 0.1, speed = std::sqrt(tension / (0.2 / length));
    const auto measure = [&](std::array<int, 2> grid, double steps) {
        Simulation simulation = verify_simulation(tape(
            grid[0] - 1, steps,
            "placed_scale = [1.1, 1]\nmaterial = { stretch = 100, shear = 0, bend = 0, stretch_damping = 0 "
            "}\n[[cloth.pin]]\nedge = \"u1\"\n",
            ""));
        const auto height = [&] { return simulation.state.x[static_cast<std::size_t>(grid[0] / 2)].y(); };
        double before = height(), now = before, behind = before;
        const double h = 1 / steps;
        while (behind <= now) {
            next_step(simulation);
            before = now;
            now = behind;
            behind = height();
        }
        // The vertex of the parabola through the last three.
        const double bend = before - 2 * now + behind;
        const double ahead = bend > 0 ? 0.5 * (before - behind) / bend : 0;
        return length / (simulation.state.t - h + ahead * h);
    };
    add_lines({{{41, 2}, {81, 2}, {161, 2}}, {1000, 2000, 4000}}, fast, "", speed, 0.05, measure,
              result.lines);
    return result;
}

}  // namespace unravel::tool
