// How cloths lie at the start: facings, start shapes, wrinkles, and mirror images of all of them.

#include <catch2/catch.hpp>

#include "sim/mesh/placement.hpp"
#include "sim/mesh/smooth_noise.hpp"
#include "sim/mesh/start_line.hpp"
#include "sim/scene_file/load.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

Cloth sheet_with(const std::string& keys) {
    return parse_scene("[cloth]\nparticles = [41, 5]\nsize = [2, 0.4]\n" + keys, "a.toml").cloths.at(0);
}

// The way along the cloth from column 0 to the last, over the chords.
double length_along_u(const Cloth& cloth) {
    double length = 0;
    for (int i = 1; i < cloth.particles[0]; ++i)
        length += (placed_particle(cloth, i, 0) - placed_particle(cloth, i - 1, 0)).norm();
    return length;
}

}  // namespace

TEST_CASE("a cloth's front looks where its facing says, and v = 0 is above where it stands", "[scene]") {
    const std::pair<const char*, Vec3> fronts[] = {{"up", {0, 1, 0}},    {"down", {0, -1, 0}},
                                                   {"front", {0, 0, 1}}, {"back", {0, 0, -1}},
                                                   {"left", {-1, 0, 0}}, {"right", {1, 0, 0}}};
    for (const auto& [word, front] : fronts) {
        INFO(word);
        const Cloth cloth = sheet_with("facing = \"" + std::string(word) + "\"\n");
        const Vec3 u = (placed_particle(cloth, 40, 0) - placed_particle(cloth, 0, 0)).normalized();
        const Vec3 v = (placed_particle(cloth, 0, 4) - placed_particle(cloth, 0, 0)).normalized();
        CHECK((v.cross(u) - front).norm() < 1e-15);
        if (front.y() == 0) CHECK((v + Vec3::UnitY()).norm() < 1e-15);
    }
    // Turned after that.
    const Cloth turned = sheet_with("facing = \"front\"\nrotation = [0, 90, 0]\n");
    CHECK((placed_particle(turned, 40, 0) - placed_particle(turned, 0, 0))
              .normalized()
              .isApprox(-Vec3::UnitZ()));
}

TEST_CASE("start shapes bend a cloth and stretch it nowhere", "[scene]") {
    for (const char* start :
         {"start = { shape = \"pleated\", pleats = 3, width = 0.8 }\n",
          "start = { shape = \"folded\", folds = 3 }\n",
          "start = { shape = \"rolled\", radius = 0.05, gap = 0.02, flat = 0.3 }\n",
          "start = { shape = \"over-bar\", radius = 0.1, share = 0.3, from = \"u1\" }\n"}) {
        INFO(start);
        const Cloth cloth = sheet_with(start);
        const StartLine line = make_start_line(*cloth.start, 2);
        double length = 0;
        for (const StartLine::Piece& piece : line.pieces) length += piece.length;
        CHECK(length == Approx(2).epsilon(1e-12));
        // In steps of 1 mm chords are shorter than arcs of radius r by (0.001 / r)² / 24 of their length.
        double chords = 0;
        for (int k = 0; k < 2000; ++k) {
            const LinePoint a = point_along(line, 0.001 * k), b = point_along(line, 0.001 * (k + 1));
            chords += (b.at - a.at).norm();
            CHECK(std::abs(b.normal.dot(b.at - a.at)) < 0.001 * 0.001 / (2 * 0.005));
        }
        CHECK(chords < 2 + 1e-9);
        CHECK(chords > 2 * (1 - 0.2 * 0.2 / 24));
        // Rows stay straight.
        for (int i = 0; i < 41; ++i)
            CHECK((placed_particle(cloth, i, 4) - placed_particle(cloth, i, 0) - Vec3(0, 0, 0.4)).norm() <
                  1e-12);
        CHECK(length_along_u(cloth) <= 2 + 1e-9);
    }
}

TEST_CASE("each start shape lies around its centre as it is told", "[scene]") {
    // Pleats: as wide as they are told, crests at the ends and evenly between.
    const Cloth pleated = sheet_with("start = { shape = \"pleated\", pleats = 4, width = 0.8 }\n");
    CHECK((placed_particle(pleated, 40, 0) - placed_particle(pleated, 0, 0) - Vec3(0.8, 0, 0)).norm() < 1e-9);
    CHECK((placed_particle(pleated, 10, 0) - placed_particle(pleated, 0, 0) - Vec3(0.2, 0, 0)).norm() < 1e-9);
    CHECK(placed_particle(pleated, 0, 0).y() == Approx(-placed_particle(pleated, 5, 0).y()));
    CHECK(placed_particle(pleated, 0, 0).y() > 0.01);
    // Folds: the layers are a gap apart.
    const Cloth folded = sheet_with("start = { shape = \"folded\", folds = 1, gap = 0.04, from = \"u1\" }\n");
    CHECK(placed_particle(folded, 40, 0).y() == Approx(-0.02));
    CHECK(placed_particle(folded, 0, 0).y() == Approx(0.02));
    CHECK(placed_particle(folded, 0, 0).x() == Approx(placed_particle(folded, 40, 0).x()));
    // A roll: its outermost turn has its radius about the centre, and what is left flat leads away below.
    const Cloth rolled =
        sheet_with("start = { shape = \"rolled\", radius = 0.05, gap = 0.02, flat = 0.5 }\n");
    const Vec3 end = placed_particle(rolled, 40, 0), before = placed_particle(rolled, 35, 0);
    CHECK((end - before - Vec3(0.25, 0, 0)).norm() < 1e-9);
    const Vec3 last = placed_particle(rolled, 30, 0);  // 0.5 m before the end
    CHECK(last.x() == Approx(0).margin(1e-9));
    CHECK(placed_particle(rolled, 29, 0).head<2>().norm() == Approx(-last.y()));
    // Over a bar: both ends hang down beside it, its top is a radius above.
    const Cloth hung = sheet_with("start = { shape = \"over-bar\", radius = 0.1, share = 0.5 }\n");
    CHECK(placed_particle(hung, 0, 0).x() == Approx(-0.1));
    CHECK(placed_particle(hung, 40, 0).x() == Approx(0.1));
    CHECK((placed_particle(hung, 20, 2) - Vec3(0, 0.1, 0)).norm() < 1e-9);
    CHECK(placed_particle(hung, 40, 0).y() < -0.8);
}

TEST_CASE("what does not fit a start shape is refused where it stands", "[scene]") {
    const auto problem = [](const std::string& keys) {
        try {
            sheet_with(keys);
        } catch (const SceneError& error) {
            REQUIRE(error.problems().size() == 1);
            const SceneProblem& found = error.problems()[0];
            return std::to_string(found.place.line) + ":" + std::to_string(found.place.column) + " " +
                   found.what;
        }
        return std::string("none");
    };
    CHECK(problem("start = { shape = \"pleated\", width = 0.3 }\n") == "4:9 a cloth of 2 m pleated to 0.3 m");
    CHECK(problem("start = { shape = \"pleated\", folds = 2 }\n") == "4:30 'folds' does not belong here");
    CHECK(problem("start = { shape = \"folded\", folds = 40, gap = 0.1 }\n").starts_with("4:9 40 folds"));
    CHECK(problem("start = { shape = \"over-bar\", radius = 0.4, share = 0.1 }\n").starts_with("4:9 a bend"));
    CHECK(problem("start = { shape = \"rolled\", radius = 0.01, gap = 0.02 }\n").starts_with("4:9 a roll"));
    CHECK(problem("wrap = \"tube\"\nstart = { shape = \"folded\" }\n").starts_with("5:9 a tube"));
}

TEST_CASE("wrinkles are smooth, bounded, and the same on any grid", "[scene]") {
    const std::string keys = "wrinkles = { height = 0.02, size = 0.2, seed = 5 }\n";
    const Cloth coarse = sheet_with(keys);
    Cloth fine = coarse;
    fine.particles = {81, 9};
    const StartPlaces on_coarse(coarse), on_fine(fine);
    double most = 0;
    for (int i = 0; i < 81; ++i) {
        for (int j = 0; j < 9; ++j) {
            const double height = on_fine.started(i, j).y();
            most = std::max(most, std::abs(height));
            if (i % 2 == 0 && j % 2 == 0)
                CHECK(on_coarse.started(i / 2, j / 2).y() == Approx(height).margin(1e-15));
            // The slope of gradient noise is below 3 of its height per unit.
            if (i > 0) CHECK(std::abs(height - on_fine.started(i - 1, j).y()) < 3 * 0.02 * 0.025 / 0.2);
        }
    }
    CHECK(most <= 0.02);
    CHECK(most > 0.003);
    CHECK(smooth_noise(5, {0.3, 0, 0.4}) != smooth_noise(6, {0.3, 0, 0.4}));
}

TEST_CASE("a mirror image is where the mirror shows it, front and pins with it", "[scene]") {
    for (const char* mirror : {"x", "y", "z"}) {
        for (const char* facing : {"up", "down", "front", "back", "left", "right"}) {
            INFO(mirror << " " << facing);
            const Scene scene = parse_scene(
                "[cloth]\nname = \"a\"\nparticles = [9, 7]\nsize = [1, 0.7]\ncenter = [2, 3, 4]\nrotation = "
                "[10, 20, 30]\n"
                "start = { shape = \"folded\", from = \"u1\", gap = 0.05 }\nmirror = \"" +
                    std::string(mirror) + "\"\nfacing = \"" + facing +
                    "\"\n[[cloth.pin]]\nedge = \"u0\"\nmotion = [{ time = 0 }, { time = 1, position = [1, 2, "
                    "3], rotation = "
                    "[10, 20, 30] }]\n[[cloth.pin]]\nparticles = [1, 3, 2, 6]\n[[cloth.pin]]\nbox = [0, 0, "
                    "0.3, 0.4]\n",
                "a.toml");
            REQUIRE(scene.cloths.size() == 2);
            const Cloth &one = scene.cloths[0], &image = scene.cloths[1];
            CHECK(image.name == "a mirrored");
            const int axis = mirror[0] - 'x';
            const auto reflect = [&](Vec3 x) {
                x[axis] *= -1;
                return x;
            };
            const auto nearest = [&](const Vec3& x) {
                std::size_t best = 0;
                const std::vector<Vec3> all = placed_particles(image);
                for (std::size_t p = 0; p < all.size(); ++p)
                    if ((all[p] - x).norm() < (all[best] - x).norm()) best = p;
                CHECK((all[best] - x).norm() < 1e-12);
                return best;
            };
            const std::vector<Vec3> places = placed_particles(one);
            // The front is the cross product of v and u, and a mirror turns cross products round.
            const auto front = [&](const Cloth& cloth, int i, int j) {
                const Vec3 at = placed_particle(cloth, i, j);
                return Vec3((placed_particle(cloth, i, j + 1) - at)
                                .cross(placed_particle(cloth, i + 1, j) - at)
                                .normalized());
            };
            const std::size_t same = nearest(reflect(places[9 * 3 + 1]));
            CHECK((front(image, static_cast<int>(same % 9), static_cast<int>(same / 9)) -
                   reflect(front(one, 1, 3)))
                      .norm() < 0.2);
            for (std::size_t k = 0; k < one.pins.size(); ++k) {
                std::vector<std::size_t> expected;
                for (const std::size_t p : pinned_particles(one, one.pins[k]))
                    expected.push_back(nearest(reflect(places[p])));
                std::sort(expected.begin(), expected.end());
                CHECK(pinned_particles(image, image.pins[k]) == expected);
            }
            const Keyframe &key = one.pins[0].motion[1], &shown = image.pins[0].motion[1];
            CHECK(shown.position == reflect(key.position));
            const Vec3 arm(0.3, -0.5, 0.7);
            CHECK((rotation_matrix(shown.rotation) * reflect(arm) -
                   reflect(rotation_matrix(key.rotation) * arm))
                      .norm() < 1e-12);
        }
    }
}
