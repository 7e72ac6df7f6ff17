#include "sim/scene_file/describe.hpp"

namespace unravel::sim {

namespace {

constexpr std::string_view start_edges[] = {"u0", "u1", "v0", "v1"};

}  // namespace

void describe(Fields& f, Start& start) {
    f.choice({"shape", "how it lies; rolled up, its front is inside", true}, start.shape);
    const StartShape shape = start.shape;
    const auto of = [&](auto... shapes) {
        return !f.reading() && !f.writing() ? true : ((shape == shapes) || ...);
    };
    f.word({"from",
            "the edge at which pleats, folds or the roll's inside begin; across it the cloth is straight"},
           start.from, start_edges);
    f.integer({"pleats", "waves, from crest to crest", false, of(StartShape::pleated)}, start.pleats, 1,
              10'000);
    f.number({"width", "m, to which it is pleated; default: half of it", false,
              of(StartShape::pleated) && (!f.writing() || start.width > 0)},
             start.width, {1e-4, 1000, false, "m"});
    f.integer({"folds", "one less than layers", false, of(StartShape::folded)}, start.folds, 1, 1000);
    f.number({"gap", "m, between layers", false, of(StartShape::folded, StartShape::rolled)}, start.gap,
             {1e-4, 10, false, "m"});
    f.number({"radius", "m, of the roll's hollow, or of the bend over the bar", false,
              of(StartShape::rolled, StartShape::over_bar)},
             start.radius, {1e-4, 100, false, "m"});
    f.number({"flat", "m, at its end that are not rolled up", false, of(StartShape::rolled)}, start.flat,
             {0, 1000, false, "m"});
    f.number({"share", "of its length that is before the middle of the bar", false, of(StartShape::over_bar)},
             start.share, {0, 1});
}

void describe(Fields& f, Wrinkles& wrinkles) {
    f.number({"height", "m, the largest; most are a third of it"}, wrinkles.height, {0, 1, false, "m"});
    f.number({"size", "m, from one wrinkle to the next"}, wrinkles.size, {1e-4, 1000, false, "m"});
    f.seed({"seed", "another seed, other wrinkles"}, wrinkles.seed);
}

}  // namespace unravel::sim
