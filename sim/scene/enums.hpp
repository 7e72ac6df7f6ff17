#pragma once

// The choices that a scene makes, each with the words by which scene files, command lines and reports name
// its values, in the order of the enum.

#include <cstddef>
#include <span>
#include <string_view>

namespace unravel::sim {

using Words = std::span<const std::string_view>;

enum class PinTarget { corner, edge, particles, box, disc, group, within };
inline constexpr std::string_view pin_target_words[] = {"corner", "edge",  "particles", "box",
                                                        "disc",   "group", "within"};
constexpr Words words_of(PinTarget) {
    return pin_target_words;
}

enum class Wrap { open, tube };
inline constexpr std::string_view wrap_words[] = {"open", "tube"};
constexpr Words words_of(Wrap) {
    return wrap_words;
}

/// How cloth resists bending: linearly in its curvature, and as arcs where it buckles between particles; or
/// by the arcs of Choi & Ko 2002 over two cells alone, as the paper has it.
enum class BendModel { curvature, buckling };
inline constexpr std::string_view bend_model_words[] = {"curvature", "buckling"};
constexpr Words words_of(BendModel) {
    return bend_model_words;
}

/// How a path goes from one keyframe to the next: a monotone cubic that is smooth where such follow each
/// other (smooth), at even speed (linear), not at all until the next is due (hold), or from rest to rest
/// (ease).
enum class Interpolation { smooth, linear, hold, ease };
inline constexpr std::string_view interpolation_words[] = {"smooth", "linear", "hold", "ease"};
constexpr Words words_of(Interpolation) {
    return interpolation_words;
}

/// Across which axis a mirror stands, at the world's origin.
enum class Mirror { none, x, y, z };
inline constexpr std::string_view mirror_words[] = {"none", "x", "y", "z"};
constexpr Words words_of(Mirror) {
    return mirror_words;
}

/// Where a sheet's front looks at the start.
enum class Facing { up, down, front, back, left, right };
inline constexpr std::string_view facing_words[] = {"up", "down", "front", "back", "left", "right"};
constexpr Words words_of(Facing) {
    return facing_words;
}

/// Which line a sheet follows at the start.
enum class StartShape { pleated, folded, rolled, over_bar };
inline constexpr std::string_view start_shape_words[] = {"pleated", "folded", "rolled", "over-bar"};
constexpr Words words_of(StartShape) {
    return start_shape_words;
}

/// Which way is up in a mesh's file.
enum class UpAxis { y, z };
inline constexpr std::string_view up_axis_words[] = {"y", "z"};
constexpr Words words_of(UpAxis) {
    return up_axis_words;
}

/// Which holes of a body are closed: those of up to a hundredth of its surface, or all.
enum class MeshHoles { small, cap };
inline constexpr std::string_view mesh_hole_words[] = {"small", "cap"};
constexpr Words words_of(MeshHoles) {
    return mesh_hole_words;
}

enum class Shape { plane, sphere, box, cylinder, capsule, mesh };
inline constexpr std::string_view shape_words[] = {"plane", "sphere", "box", "cylinder", "capsule", "mesh"};
constexpr Words words_of(Shape) {
    return shape_words;
}

/// `automatic` takes explicit substeps or adaptive IMEX, whichever is counted cheaper
/// (sim/step/choose_integrator.hpp).
enum class Integrator { explicit_, implicit, newton, imex, adaptive_imex, bdf2, adaptive_imex2, automatic };
inline constexpr std::string_view integrator_words[] = {
    "explicit", "implicit", "newton", "imex", "adaptive-imex", "bdf2", "adaptive-imex2", "auto"};
constexpr Words words_of(Integrator) {
    return integrator_words;
}

/// `automatic` chooses per component. `stencil_block` is the constrained block, and `multigrid` a cycle by
/// lines, in single precision on the stencil of a grid; what lies on no grid gets the constrained block on
/// rows. `aggregation` is a multigrid cycle on rows, on whatever mesh they are.
enum class Preconditioner {
    none,
    diagonal,
    block,
    constrained_block,
    ssor,
    ic0,
    automatic,
    stencil_block,
    multigrid,
    aggregation
};
inline constexpr std::string_view preconditioner_words[] = {
    "none", "diagonal", "block",         "constrained-block", "ssor",
    "ic0",  "auto",     "stencil-block", "multigrid",         "aggregation"};
constexpr Words words_of(Preconditioner) {
    return preconditioner_words;
}

/// How bending is treated: as the integrator has it (implicitly by implicit and newton, by its own κ by the
/// others), or explicitly by all.
enum class BendTreatment { scheme, explicit_ };
inline constexpr std::string_view bend_treatment_words[] = {"scheme", "explicit"};
constexpr Words words_of(BendTreatment) {
    return bend_treatment_words;
}

/// When a spring that is slack at the start of a step begins to act within it: not before the next step
/// (start); where the last step's motion carried on would make it taut, and, solved again, where the solution
/// stretches one beyond what may be missed (predicted); wherever the solution makes it taut, in a second
/// solve (resolve); or where it is taut at x + h v, at which implicit springs are then linearised (ahead):
/// the first iteration of Newton's method for backward Euler, begun where the step would end without forces.
enum class Activation { start, predicted, resolve, ahead };
inline constexpr std::string_view activation_words[] = {"start", "predicted", "resolve", "ahead"};
constexpr Words words_of(Activation) {
    return activation_words;
}

/// What meets what: particles alone; or vertices, edges and faces of the cloth.
enum class ContactMethod { particles, surface };
inline constexpr std::string_view contact_method_words[] = {"particles", "surface"};
constexpr Words words_of(ContactMethod) {
    return contact_method_words;
}

/// What of the cloth a solid holds off: what it takes to hold off all of it; or as above.
enum class SolidContact { automatic, particles, surface };
inline constexpr std::string_view solid_contact_words[] = {"auto", "particles", "surface"};
constexpr Words words_of(SolidContact) {
    return solid_contact_words;
}

enum class Weave { plain, twill, checks, stripes, solid };
inline constexpr std::string_view weave_words[] = {"plain", "twill", "checks", "stripes", "solid"};
constexpr Words words_of(Weave) {
    return weave_words;
}

/// How a solid's surface takes the light.
enum class Finish { satin, matt, gloss, metal };
inline constexpr std::string_view finish_words[] = {"satin", "matt", "gloss", "metal"};
constexpr Words words_of(Finish) {
    return finish_words;
}

/// What the component view is drawn on: a screen, or a page.
enum class Theme { dark, paper };
inline constexpr std::string_view theme_words[] = {"dark", "paper"};
constexpr Words words_of(Theme) {
    return theme_words;
}

/// What the colours of the component view tell.
enum class Show { components, splitting, strain, velocity, contact };
inline constexpr std::string_view show_words[] = {"components", "splitting", "strain", "velocity", "contact"};
constexpr Words words_of(Show) {
    return show_words;
}

template <class Enum>
constexpr std::string_view word_of(Enum value) {
    return words_of(value)[static_cast<std::size_t>(value)];
}

}  // namespace unravel::sim
