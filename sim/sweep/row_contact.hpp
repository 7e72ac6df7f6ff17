#pragma once

#include <vector>

#include "sim/constraints/contact.hpp"
#include "sim/constraints/friction.hpp"
#include "sim/model/model.hpp"
#include "sim/rows/sweep_row.hpp"

namespace unravel::sim {

/// Contact of a stretch of one row with solids, within the explicit sweep. Most of a cloth is far from every
/// solid most of the time: each stretch remembers a distance that it is known to keep, shortened by what it
/// and the solids move, and looks again when that is used up.

/// Columns looked at together.
inline constexpr std::size_t contact_columns = 64;

/// What contact needs to know of a substep.
struct SolidSubstep {
    SolidPoses poses;
    double travel = 0;  ///< m, farthest that a solid's surface moves; infinite where unknown
};
/// Poses and travel of the substep of h seconds from t.
void pose_substep(std::span<const Solid> solids, double t, double h, SolidSubstep& out);

/// A stretch of a row between substeps. Contacts count columns from the stretch's first.
struct RowContacts {
    double clearance = -1;  ///< m, every particle is at least so far outside every solid's offset
    std::vector<Contact> contacts;
    std::vector<Constraint> constraints;  ///< of the last substep; columns too
    std::uint32_t touches = 0;            ///< of the last substep
};

/// Memory of one thread.
struct RowContactScratch {
    std::vector<Vec3> x, v, base, impulse, dv;
    Reactions reactions;
    std::vector<double> mass, inertia;
    Constraints constraints;
    std::vector<std::vector<Touch>> found;
    std::vector<Touch> touches;
};

struct RowStretch {
    Row x, v, f;
    const double* mass;
    std::size_t count;
    std::span<const std::uint32_t> pinned;  ///< columns that a pin moves; they touch nothing
};

/// True where the stretch may touch something in a substep of h seconds, so that contact must be looked into.
bool may_touch(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch, double h,
               RowContacts& contacts);

/// Before the row moves: finds touches and what they do to the stretch, in scratch.
void meet_solids(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch, double h,
                 RowContacts& contacts, RowContactScratch& scratch);

/// After the row has moved freely: puts what touched where contact has it, where the stretch `met` solids,
/// and what got inside outside.
void settle_contacts(const ClothModel& model, const SolidSubstep& substep, const RowStretch& stretch,
                     double h, bool met, RowContactScratch& scratch);

/// After a row that met nothing has moved: shortens its clearance. False where that is used up, so that it
/// may be inside a solid.
bool keeps_clear(const SolidSubstep& substep, const RowStretch& stretch, double h, RowContacts& contacts);

}  // namespace unravel::sim
