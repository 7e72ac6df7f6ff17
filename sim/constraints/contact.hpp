#pragma once

#include <span>
#include <vector>

#include "sim/constraints/constraints.hpp"
#include "sim/model/state.hpp"
#include "sim/scene/math.hpp"
#include "sim/scene/scene.hpp"
#include "sim/solids/motion.hpp"
#include "sim/solids/sdf.hpp"

namespace unravel::sim {

/// Contact of particles with solids by constraints (Baraff & Witkin 1998, Sec. 5–6): a touching particle
/// loses the direction of the solid's normal; static friction (sim/constraints/friction.hpp) takes all three.
/// Two contacts take two directions, three or a pinch between two solids ("flypapering", Baraff, Witkin &
/// Kass 2003) all.

/// A contact that has opened by this share of the solid's offset is over.
inline constexpr double open_share = 0.5;

/// What tells at once that a particle is far from a solid: the ball that holds it, or a plane's half space.
struct SolidReach {
    bool plane = false;
    Vec3 now{0, 0, 0}, next{0, 0, 0};  ///< m, centre, at both ends of the step
    Vec3 normal{0, 1, 0};              ///< of a plane that rests
    double radius = 0;                 ///< m; infinite for a plane that moves
    double travel = 0;                 ///< m, of the centre over the step
    double turn = 0;                   ///< radians over the step, at most
    double skin = 0;                   ///< m, gap below which a known contact is still one, with the offset

    /// No contact in a step in which a particle at x moves by `ahead` metres: what turns with the solid comes
    /// nearer by at most turn times its distance.
    bool is_far(const Vec3& x, double ahead) const {
        if (plane) return normal.dot(x - now) > skin + ahead;
        return (1.0 - turn) * (x - now).norm() > radius + skin + travel + ahead;
    }
    /// Certainly not inside at the end of the step.
    bool is_outside(const Vec3& x) const {
        if (plane) return normal.dot(x - next) >= 0;
        return (x - next).squaredNorm() >= radius * radius;
    }
};

/// Where each solid is at the beginning and at the end of a step.
struct SolidPoses {
    std::vector<Pose> now, next;          ///< (solids)
    std::vector<DeformedSolid> deformed;  ///< (solids) or empty where none deforms
    std::vector<SolidReach> reach;        ///< (solids)
    const DeformedSolid* of(const Solid& solid, std::size_t index) const;
};
void pose_solids(std::span<const Solid> solids, double t, double h, SolidPoses& out);

/// A contact as seen in this step.
struct Touch {
    Contact contact;
    Vec3 normal{0, 1, 0};    ///< unit, out of the solid
    Vec3 velocity{0, 0, 0};  ///< m/s, of the solid's material at the particle, over the step
    double gap = 0;          ///< m, distance beyond the solid's offset; negative: too deep
    bool pinched = false;    ///< held between two solids
    bool is_new = true;      ///< was none in the last step, or had let go
    // Friction (sim/constraints/friction.hpp)
    double drag = 0;           ///< kg, c of its sliding
    Vec3 rub{0, 0, 0};         ///< kg·m/s, friction where it begins to slide
    double drag_added = 0;     ///< kg, what of c is in the system
    Vec3 push_added{0, 0, 0};  ///< kg·m/s, and on its right-hand side
};

/// The discrete step as the constraints see it: x' = base + h v' with v' = v + Δv.
struct StepView {
    std::span<const Vec3> x;  ///< (particles) where they are [m]
    std::span<const Vec3> v;  ///< (particles) what Δv is added to [m/s]
    std::span<const double> mass;
    double h = 0;           ///< s, factor of v' in x'
    Vec3 gravity{0, 0, 0};  ///< m/s²: foreseen in what will touch; its size scales forces that count as none
    double step = 0;        ///< s, from x to x'
    double h_force = 0;     ///< s, factor of forces in the impulses
};

/// Finds what touches: contacts of the last step that have not opened, and particles that would enter a
/// solid's offset within the step. Sorted by particle, then solid. `pinned` particles touch nothing;
/// `found` is scratch.
void find_touches(std::span<const Solid> solids, const SolidPoses& poses, const StepView& view,
                  std::span<const Contact> known, const Constraints& pinned,
                  std::vector<std::vector<Touch>>& found, std::vector<Touch>& out);

/// Lets a particle between two solids that leave it room touch the nearer one alone, marks what they pinch,
/// and puts particles out of what they are too deep in.
///   base  (particles) positions x' starts from [m]; depth corrections are added here, never to a velocity
void settle_touches(std::span<const Solid> solids, const StepView& view, std::vector<Touch>& touches,
                    std::span<Vec3> base);

/// Turns touches, held or sliding, into constraints.
///   base  (particles) positions x' starts from, without depth corrections [m]
void constrain_touches(std::span<const Solid> solids, const StepView& view, std::span<const Touch> touches,
                       std::span<const Vec3> base, Constraints& constraints);

/// The last resort after a step: contacts are foreseen from velocities, and what a taut spring flings into a
/// fast solid within the step is not. Such a particle is put back on the solid's surface, within its skin,
/// and no longer moves into it. Does nothing to what is fully constrained.
///   x, v  (particles) at the end of the step
void keep_outside(std::span<const Solid> solids, const SolidPoses& poses, const Constraints& constraints,
                  double h, std::span<Vec3> x, std::span<Vec3> v);

}  // namespace unravel::sim
