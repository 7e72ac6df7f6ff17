#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/forces/air.hpp"
#include "sim/forces/bend.hpp"
#include "sim/forces/curvature.hpp"
#include "sim/forces/extension.hpp"
#include "sim/forces/grid_springs.hpp"
#include "sim/scene/math.hpp"
#include "sim/scene/scene.hpp"

namespace unravel::sim {

/// One cloth's share of the particles: the grid i + j·particles[0] from `first` on, i along u; or a mesh.
struct ClothPatch {
    std::string name;
    std::uint32_t first = 0;
    std::array<int, 2> particles{0, 0};
    std::array<double, 2> size{0, 0};  ///< m
    bool tube = false;                 ///< closed in u
    /// Null: a grid. Otherwise `particles` is {vertices, 1}, particle first + v is vertex v, and what belongs
    /// to grids (rows, cells, families of springs by direction) is not there.
    std::shared_ptr<const MeshCloth> mesh;
    bool grid() const { return mesh == nullptr; }
    std::uint32_t count() const {
        return static_cast<std::uint32_t>(particles[0]) * static_cast<std::uint32_t>(particles[1]);
    }
    /// Cells along u and v.
    int cells_u() const { return tube ? particles[0] : particles[0] - 1; }
    int cells_v() const { return particles[1] - 1; }
    std::uint32_t at(int i, int j) const {
        return first + static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(particles[0]) +
               static_cast<std::uint32_t>(tube ? i % particles[0] : i);
    }
};

/// Particles that a pin of the scene moves.
struct PinnedGroup {
    std::vector<std::uint32_t> particles;  ///< sorted
    std::vector<Vec3> start;               ///< (particles of the group) where they stand at t = 0 [m]
    Vec3 centre{0, 0, 0};                  ///< m, what the motion turns about
    Motion motion;
    double release = 0;  ///< s; +∞: never
    Carried carried;     ///< the body that takes it along, after its own motion
    /// Drawn together: at `gather_begin` [s] its particles are where they start, `gather_time` [s] later at
    /// this share of their distance from the centre, and stay there. 1: they are not.
    double gather = 1, gather_begin = 0, gather_time = 1;
    Vec3 slide{0, 0, 0};         ///< unit, at the start: the direction in which they are free; zero: in none
    Vec3 rod{0, 0, 0};           ///< m, at the start: the middle of what they slide on
    double reach = 0;            ///< m along it from there, beyond which they don't slide; 0: it has no ends
    std::vector<int> triangles;  ///< (particles) of a body that deforms: what each rides on; empty: of none
    bool slides() const { return !slide.isZero(0); }
    /// Whether it takes its particles elsewhere while it holds them.
    bool moves() const {
        return !motion.empty() || gather != 1 || !triangles.empty() || (carried.by && carried.by->moves());
    }
};

/// Particles near each other along a mesh, which never collide: those of p are sorted in
/// list[start[p] … start[p+1]).
struct Neighbours {
    std::vector<std::uint32_t> start;  ///< (particles + 1) or empty where every cloth is a grid
    std::vector<std::uint32_t> list;
};

/// Stitches that sew a mesh together: springs whose rest length shrinks to nothing, linearly until `closed`.
/// They act in extension only.
struct Stitches {
    std::vector<std::uint32_t> i, j;         ///< (stitches) particles, i < j
    std::vector<double> start;               ///< (stitches) distance at t = 0 [m]
    std::vector<double> stiffness, damping;  ///< (stitches) N/m, N·s/m
    std::vector<double> closed;              ///< (stitches) s
    std::size_t size() const { return i.size(); }
};

struct ContactModel;  // sim/model/contact_model.hpp
struct ForceTerm;     // sim/terms/term.hpp

/// Everything that does not change while the cloth moves: topology, rest shape, masses, springs, pins, and
/// the effects that the scene calls for. Const once built.
struct ClothModel {
    std::vector<ClothPatch> cloths;
    std::vector<double> mass;  ///< (particles) kg: density times the area that is nearer to it than to others
    ExtensionSprings springs;  ///< stretch and shear
    Adjacency spring_adjacency;
    BendSprings bends;  ///< arcs: of bending by buckling alone over two cells, else between neighbours
    CurvatureStencils curvature;     ///< bending that is linear in curvature; empty: none
    std::vector<GridSprings> grids;  ///< one per cloth that is a grid: its springs by direction
    Stitches stitches;               ///< empty where no mesh has seams
    std::vector<PinnedGroup> pins;
    double begin = 0;           ///< s, when the simulation begins; below 0: it settles first
    Vec3 gravity{0, 0, 0};      ///< m/s²
    std::vector<Solid> solids;  ///< what the cloth meets; empty: no contact at all
    bool may_touch = false;     ///< whether the cloth can come to any of them (sim/model/reach.hpp)
    std::optional<Wind> wind;   ///< absent: no air at all, or none that could act
    std::optional<SelfCollision> self_collision;  ///< absent: none; what the scene leaves open is filled in
    std::shared_ptr<const ContactModel> contact;  ///< null where no surfaces meet (make_contact_model())
    Neighbours neighbours;                        ///< of particles of meshes; empty without self-collision
    std::vector<std::string> notes;               ///< where springs can't do what the scene says
    std::vector<const ForceTerm*> further_terms;  ///< forces besides those of scenes; not owned
    std::size_t size() const { return mass.size(); }
    /// Whether cloth meets cloth, or a solid, between surfaces.
    bool cloth_by_surfaces() const {
        return self_collision && self_collision->method == ContactMethod::surface;
    }
    bool solids_by_surfaces() const;
    bool by_surfaces() const { return cloth_by_surfaces() || solids_by_surfaces(); }
};

/// The cells of all cloths, for the air.
AirCells air_cells(const ClothModel& model);

/// Positions and velocities at t = 0. (particles) [m], [m/s]
struct Placement {
    std::vector<Vec3> x, v;
};

/// Builds the model of a checked scene, and where its particles start. Spring constants follow from the
/// material so that refining a grid refines the same cloth: with cells of a × b metres,
///   stretch along u: k_s = E_u · (width of the strip it stands for)/a, half a strip along an edge, less what
///   the diagonals of the cells beside it resist (sim/model/moduli.hpp);
///   shear: k_s = G (a² + b²)/(a b): a cell in shear has one diagonal in extension, and that one alone gives
///   G; bend: c = B·(width of the strip)/a³ of particles in a line, 2 B/(a b) of a cell's twist, of energy
///   ½ B κ² per area for a cylinder of any direction (sim/forces/curvature.hpp); k_b = B·(width of the strip)
///   of arcs, c_b so that the push has reached the arc's own at the material's buckling strain. By buckling
///   alone k_b = B·(width)/3 along rows, columns and diagonals over two cells, likewise on square cells.
/// Damping scales as the stiffness it goes with.
ClothModel build_model(const Scene& scene, Placement& placement);

}  // namespace unravel::sim
