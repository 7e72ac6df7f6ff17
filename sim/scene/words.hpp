#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "sim/scene/scene.hpp"

namespace unravel::sim {

// Words by which scene files, command lines and reports name the values of scene.hpp's enums, in the order of
// the enums.

using Words = std::span<const std::string_view>;

inline constexpr std::string_view pin_target_words[] = {"corner", "edge",  "particles", "box",
                                                        "disc",   "group", "within"};
inline constexpr std::string_view wrap_words[] = {"open", "tube"};
inline constexpr std::string_view up_axis_words[] = {"y", "z"};
inline constexpr std::string_view mesh_hole_words[] = {"small", "cap"};
inline constexpr std::string_view shape_words[] = {"plane", "sphere", "box", "cylinder", "capsule", "mesh"};
inline constexpr std::string_view integrator_words[] = {
    "explicit", "implicit", "newton", "imex", "adaptive-imex", "bdf2", "adaptive-imex2", "auto"};
inline constexpr std::string_view preconditioner_words[] = {
    "none", "diagonal", "block",         "constrained-block", "ssor",
    "ic0",  "auto",     "stencil-block", "multigrid",         "aggregation"};
inline constexpr std::string_view bend_treatment_words[] = {"scheme", "explicit"};
inline constexpr std::string_view activation_words[] = {"start", "predicted", "resolve", "ahead"};
inline constexpr std::string_view collision_method_words[] = {"surface", "particles"};
inline constexpr std::string_view weave_words[] = {"plain", "twill", "checks", "stripes", "solid"};
inline constexpr std::string_view show_words[] = {"components", "splitting", "strain", "velocity", "contact"};

constexpr Words words_of(PinTarget) {
    return pin_target_words;
}
constexpr Words words_of(Wrap) {
    return wrap_words;
}
constexpr Words words_of(UpAxis) {
    return up_axis_words;
}
constexpr Words words_of(MeshHoles) {
    return mesh_hole_words;
}
constexpr Words words_of(Shape) {
    return shape_words;
}
constexpr Words words_of(Integrator) {
    return integrator_words;
}
constexpr Words words_of(Preconditioner) {
    return preconditioner_words;
}
constexpr Words words_of(BendTreatment) {
    return bend_treatment_words;
}
constexpr Words words_of(Activation) {
    return activation_words;
}
constexpr Words words_of(CollisionMethod) {
    return collision_method_words;
}
constexpr Words words_of(Weave) {
    return weave_words;
}
constexpr Words words_of(Show) {
    return show_words;
}

template <class Enum>
constexpr std::string_view word_of(Enum value) {
    return words_of(value)[static_cast<std::size_t>(value)];
}

}  // namespace unravel::sim
