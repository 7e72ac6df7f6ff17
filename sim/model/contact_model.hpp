#pragma once

#include "sim/model/model.hpp"
#include "sim/model/reach.hpp"
#include "sim/surface/impact.hpp"
#include "sim/surface/surface_tree.hpp"

namespace unravel::sim {

/// What contact between surfaces reads of the model, and who counts crossings. Const once built.
struct ContactModel {
    Surface surface;
    SurfaceTree tree;  ///< as at the start
    /// Of each particle: those that are as near along the cloth as layers may come, and never touch it;
    /// sorted.
    Lists near;
    std::vector<double> thickness;  ///< (cloths) m; two touch at the mean of theirs
    std::vector<double> wanted;     ///< (cloths) m, what it would be if the start allowed it
    double stiffness = 0;           ///< N/m, of a contact
    double damping = 0;             ///< N·s/m, of a contact; 0: a fifth of critical
    Friction friction;              ///< between layers

    /// Whether any corner of one feature is near one of the other along the cloth: such never touch.
    bool are_near(FeaturePair kind, const std::array<std::uint32_t, 4>& particles) const;
    /// At which the cloths of two particles touch. [m]
    double pair_thickness(std::uint32_t p, std::uint32_t q) const;
};

/// The longest thread between particles of the cloth that are neighbours, at rest [m].
double widest_spacing(const ClothModel& model);

/// Whether cloth may sag into a solid between particles `spacing` apart that it holds off: a chord between
/// two points at its offset d from a rounding of radius r meets it where it is longer than 2 √(d (2r + d)).
/// Never of planes, nor of meshes, of which edges and faces are not held off.
bool needs_surfaces(const Solid& solid, double spacing);

/// Decides what the scene leaves open of a model that has its springs and solids: solids that the cloth can
/// come to and its particles may miss hold off edges and faces, too.
void choose_solid_contacts(const Reach& reach, ClothModel& model);

/// Builds it for a model that has its cloths, springs and masses; null where crossings can't be: a single
/// cloth without self-collision, and no solid but planes and meshes. Thickness and near particles are only
/// there where cloth meets cloth between surfaces. A thickness that the scene leaves open is that of cloth of
/// 100 kg/m³, at least half a millimetre and at most five. Where layers are nearer than that at the start, it
/// is what they have.
std::shared_ptr<const ContactModel> make_contact_model(const Scene& scene, const ClothModel& model,
                                                       const Placement& placement);

}  // namespace unravel::sim
