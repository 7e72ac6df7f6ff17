#pragma once

// The scene as the user wrote it: plain values in SI units, checked by load_scene() (load.hpp), read by
// everything downstream and changed by nothing. An optional that is empty, or a list that is empty, is an
// effect that the scene does not call for: it is not simulated at all.
//
// World: right-handed, y up, metres, kilograms, seconds. Angles are degrees here and nowhere else.

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/scene/enums.hpp"
#include "sim/scene/path.hpp"
#include "sim/scene/rate.hpp"
#include "sim/scene/start_shape.hpp"

namespace unravel::sim {

using Vec3 = Eigen::Vector3d;
using Vec2 = Eigen::Vector2d;

struct MeshCloth;  // sim/mesh/mesh_cloth.hpp
struct MeshSolid;  // sim/mesh/mesh_solid.hpp

/// A place in the scene file (1-based), in the n-th file that it includes when `file` is positive, or in the
/// n-th --set option when `option` is.
struct SourcePlace {
    int line = 0;
    int column = 0;
    int option = 0;
    int file = 0;
};

struct Clip {
    double duration = 3.0;  ///< s; frames 0 … round(duration·fps), frame k due at exactly k/fps
    Rate fps;
    std::array<int, 2> size{1280, 720};  ///< pixels; both even where an mp4 is made
    double settle = 0;  ///< s simulated before frame 0 and not shown; what moves stands as at 0 meanwhile
    int frames() const { return static_cast<int>(std::lround(duration * fps.per_second())) + 1; }
};

/// Elastic constants of a cloth as a continuum, so that refining the grid refines the same cloth.
/// The springs' own constants are derived from them in model.cpp.
struct Material {
    std::string preset;  ///< name of the preset that gave the defaults; empty: none
    std::array<double, 2> stretch{50.0,
                                  50.0};  ///< N/m along u (weft) and v (warp): force per width per strain
    std::array<double, 2> stretch_damping{1e-3, 1e-3};  ///< N·s/m
    double shear = 5.0;                                 ///< N/m, in-plane shear modulus times thickness
    double shear_damping = 1e-4;                        ///< N·s/m
    double bend = 1e-5;                                 ///< N·m, bending stiffness per width (B)
    double buckling_strain = 0.02;  ///< compression at which a strip's push is the buckled arc's
};

/// Where in a cloth's own square: u, v ∈ [0, 1].
struct UvBox {
    Vec2 low{0, 0}, high{1, 1};
};
struct UvDisc {
    Vec2 center{0.5, 0.5};
    double radius = 0;  ///< m along the flat cloth
};

/// A part of a cloth made of something else (interfacing, a hem, a lead weight).
struct Region {
    UvBox box;
    std::string group;                 ///< of a mesh, instead of the box
    std::optional<Material> material;  ///< absent: the cloth's own
    std::optional<double> density;     ///< kg/m²; absent: the cloth's own
    SourcePlace place;
};

/// A box in the world, at the start.
struct WorldBox {
    Vec3 low{0, 0, 0}, high{0, 0, 0};  ///< m
};

struct Solid;

/// What is carried by a body: where that goes, it goes. Set by the loader from the body's name.
struct Carried {
    std::shared_ptr<const Solid> by;  ///< null: by nothing
    int triangle = -1;                ///< of a mesh that deforms: the one that it rides on
};

/// Particles whose motion is prescribed: fully constrained from the start until `release`.
struct Pin {
    PinTarget target = PinTarget::corner;
    std::string name;  ///< corner: "u0v0", "u1v0", "u0v1", "u1v1"; edge: "u0", "u1", "v0", "v1"
    int count = 0;     ///< edge: of the particles along it so many, evenly spaced; 0: all
    std::array<int, 4> range{0, 0, 0, 0};  ///< particles: first and last grid index along u, then along v
    UvBox box;
    UvDisc disc;
    std::string group;  ///< of a mesh's vertices
    WorldBox within;    ///< a mesh's vertices in it
    Motion motion;      ///< displacement from, and rotation about the centre of, the pinned particles
    std::string to;     ///< name of the solid that it rides on; empty: the world
    Carried carried;    ///< by that solid
    std::optional<double> gather;   ///< edge: m, to which the row of its particles is drawn together
    double gather_time = 1;         ///< s that this takes, from the start of the simulation
    Vec3 slide{0, 0, 0};            ///< direction in which its particles are free; zero: in none
    std::string rod;                ///< name of the cylinder or capsule that they slide on; empty: none
    std::optional<double> release;  ///< s; absent: never
    SourcePlace place;
};

/// A mesh as a scene names it, and how it is to be taken.
struct MeshFile {
    std::string file;           ///< empty: none
    std::string object, group;  ///< the part of it that is meant; empty: all
    double scale = 1;           ///< metres per unit of the file
    UpAxis up = UpAxis::y;
    std::optional<bool>
        merge;  ///< vertices in one place are one; absent: a body's are, a cloth's are a problem
    MeshHoles holes = MeshHoles::small;  ///< of bodies
    double shell = 0;                    ///< m, of a body that is a surface with two sides; 0: it is solid
    std::string hash;  ///< of the file's content, in a run's own scene: the run is tied to it
};

/// How a mesh's seams close.
struct Sewing {
    double time = 1.0;     ///< s; distances shrink evenly to nothing over it
    double stiffness = 0;  ///< N/m of each stitch; 0: ten times the cloth's stiffest edge
};

/// A sheet of particles.u × particles.v. Unrotated it lies in the x–z plane, u along +x, v along +z, its
/// front (+y) up. A tube is closed in u: its axis is z, its circumference size[0], its front outside. A mesh
/// takes the place of both: `particles` is then {vertices, 1}, and it stands where its file has it.
struct Cloth {
    std::string name;
    MeshFile mesh;
    std::shared_ptr<const MeshCloth> geometry;  ///< of the mesh, read by the loader; null: a grid
    Sewing sewing;
    std::array<int, 2> particles{51, 51};
    std::array<double, 2> size{1.0, 1.0};  ///< m, flat and at rest
    double density = 0.2;                  ///< kg/m²
    Wrap wrap = Wrap::open;
    Vec3 center{0, 0, 0};                      ///< m
    Vec3 rotation{0, 0, 0};                    ///< degrees about x, then y, then z
    Vec3 velocity{0, 0, 0};                    ///< m/s at the start
    std::array<double, 2> placed_scale{1, 1};  ///< size as placed over size at rest (1.08: 8% pre-stretched)
    Facing facing = Facing::up;                ///< before it is rotated
    std::optional<Start> start;                ///< absent: flat, or the tube that it is
    std::optional<Wrinkles> wrinkles;
    double jitter = 0;       ///< m, seeded random displacement along the normal at the start
    std::uint32_t seed = 1;  ///< of the jitter
    Material material;
    BendModel bend_model = BendModel::curvature;
    std::vector<Region> regions;
    std::vector<Pin> pins;
    Repeat repeat;  ///< as read; the loader has replaced it by cloths of their own
    SourcePlace place;
};

/// How a mesh deforms: by the samples of a PC2 file, or of files numbered where the name has '#', or by an
/// animation in the mesh's own file.
struct MeshFrames {
    std::string files;      ///< empty: no samples
    std::string animation;  ///< its name; empty: none
    double fps = 30;        ///< samples per second
    double start = 0;       ///< s, when the first is due; before it the first holds, after the last the last
    bool loop = false;      ///< after the last the first follows at once, and so on
    bool deforms() const { return !files.empty() || !animation.empty(); }
};

struct Friction {
    double static_ = 0.5;  ///< coefficient while held
    double kinetic = 0.4;  ///< coefficient while sliding, ≤ static_
};

/// A rigid implicit surface. Unrotated: a plane faces +y; cylinders and capsules stand along y.
struct Solid {
    std::string name;
    Shape shape = Shape::sphere;
    MeshFile mesh;
    MeshFrames frames;
    std::shared_ptr<const MeshSolid> geometry;  ///< of the mesh, read by the loader
    double radius = 0.3;                        ///< sphere, cylinder, capsule [m]
    double height = 1.0;  ///< cylinder: whole height; capsule: between the centres of its caps [m]
    Vec3 size{1, 1, 1};   ///< box: full edge lengths [m]
    double round = 0.0;   ///< box, cylinder: radius of the rounded edges [m]
    Vec3 center{0, 0, 0};
    Vec3 rotation{0, 0, 0};    ///< degrees
    Motion motion;             ///< displaces and turns it (about `pivot`) from where it stands
    Vec3 pivot{0, 0, 0};       ///< m, in the world at the start; default: its centre
    std::optional<Fall> fall;  ///< after its motion
    std::string parent;        ///< name of the solid that it rides on; empty: the world
    Carried carried;           ///< by that solid
    Repeat repeat;             ///< as read; the loader has replaced it by solids of their own
    Friction friction;
    double offset = 0.004;  ///< m, distance at which cloth is held off the surface (its skin)
    SolidContact contact = SolidContact::automatic;  ///< what of the cloth it holds off; a model has decided
    std::string color;                               ///< "#rrggbb"; empty: the look's default
    SourcePlace place;

    /// Whether it holds off edges and faces of the cloth, too. No edge cuts a plane whose ends are both
    /// outside, so that a plane needs no more than particles.
    bool by_surfaces() const {
        return contact == SolidContact::surface && shape != Shape::plane && shape != Shape::mesh;
    }
    /// Whether its place or its rotation changes.
    bool moves() const {
        return !motion.empty() || fall || (carried.by && (carried.triangle >= 0 || carried.by->moves()));
    }
};

/// Step size chosen while running; a rejected step is undone exactly.
struct AdaptiveStep {
    double smallest = 1e-5;   ///< s; the run stops where this would not do
    double max_strain = 0.1;  ///< a step that leaves a larger increase of stretch is rejected
    double tolerance = 0;     ///< m, local error per step; 0: not tested
    SourcePlace place;
};

struct Solver {
    Integrator integrator = Integrator::adaptive_imex;
    double step = 1.0 / 240;  ///< s; divides the frame; default: the largest such up to 1/240
    int substeps = 1;         ///< of `explicit`, in each step; 0: as many as its limit of stability asks for
    double threshold = 0.2;   ///< on κ of (7): explicit where κ ≤ threshold
    Preconditioner preconditioner = Preconditioner::automatic;
    double tolerance = 1e-3;    ///< relative preconditioned residual
    int max_iterations = 2000;  ///< of CG, per component
    bool decompose = true;      ///< false: one system over all particles
    BendTreatment bend = BendTreatment::scheme;
    Activation activation = Activation::predicted;
    double activation_band = 0;  ///< springs with l > (1 − band) L get their Jacobian, but no force
    std::optional<AdaptiveStep> adaptive;  ///< absent: every step is `step`
};

/// Gusts: a smooth seeded random factor on the wind.
struct Gust {
    double strength = 0.5;  ///< standard deviation of the speed over its mean
    double period = 1.0;    ///< s
    std::uint32_t seed = 1;
};

struct WindKey {
    double time = 0;
    Vec3 velocity{0, 0, 0};
};

/// Air. Present with zero velocity: still air that resists.
struct Wind {
    Vec3 velocity{0, 0, 0};          ///< m/s
    std::vector<WindKey> keyframes;  ///< replaces `velocity`
    std::optional<Gust> gust;
    double density = 1.2;  ///< kg/m³
    double drag = 1.0;     ///< coefficient on the normal velocity
    double lift = 0.0;     ///< coefficient on the tangential velocity
    SourcePlace place;
};

struct SelfCollision {
    ContactMethod method = ContactMethod::surface;  ///< `particles`: as in the paper, Sec. 2.2
    double thickness = 0;  ///< m; 0: from the particles' spacing; of surfaces from each cloth's density
    double stiffness = 0;  ///< N/m of a contact; 0: from the material
    double damping = 0;    ///< N·s/m; of surfaces 0 is a fifth of critical
    Friction friction;     ///< between layers; between surfaces only
    SourcePlace place;
};

struct Camera {
    std::string name;
    Vec3 position{1.6, 1.2, 1.9};
    Vec3 target{0, 0.3, 0};
    double fov = 35;   ///< degrees, vertical
    double orbit = 0;  ///< degrees turned about the target over the clip
    struct Key {
        double time = 0;
        Vec3 position{0, 0, 0}, target{0, 0, 0};
    };
    std::vector<Key> keyframes;
    Interpolation interpolation = Interpolation::smooth;  ///< of the keyframes
    std::string follow;   ///< name of a solid or cloth that position and target go along with; empty: none
    bool fit = false;     ///< goes back or forth along its line of sight until the scene fills the picture
    double aperture = 0;  ///< m, across the lens; 0: all is sharp. Drawn at final quality only
    std::optional<double> focus;  ///< m, distance of what is sharp; absent: the target's
};

struct ClothLook {
    Weave weave = Weave::checks;
    std::string front = "#b03a48", front_second = "#f2e6d8";  ///< the two yarn colours of the front
    std::string back = "#7d2a35";
    double scale = 0.05;  ///< m, period of checks or stripes
    std::string texture;  ///< PNG file beside the scene; empty: the weave
};

struct BodyLook {
    Finish finish = Finish::satin;
    std::string texture;  ///< PNG file beside the scene, laid on from three sides; empty: none
    double scale = 0.5;   ///< m of the surface that the picture spans
};

/// The lamp that casts shadows with edges.
struct Sun {
    Vec3 direction{-0.35, 0.8, 0.5};  ///< towards it; need not be unit
    std::string color;                ///< empty: a warm white
    double strength = 1;              ///< of the usual
    std::optional<double> softness;   ///< degrees that it is across; absent: 5.7
};

/// Light from all around.
struct Sky {
    std::string color;    ///< empty: a cool white with a share of the background
    double strength = 1;  ///< of the usual
    std::string image;    ///< PNG file beside the scene, all directions on twice as wide as high; empty: none
    bool show = false;    ///< the image is also the background
};

struct Look {
    std::vector<ClothLook> cloth;  ///< one per cloth; the last serves the rest
    std::vector<BodyLook> body;    ///< one per solid; the last serves the rest
    Sun sun;
    Sky sky;
    double exposure = 0;  ///< stops: each doubles all light
    std::string background = "#d8dee6";
    std::string background_top;    ///< of a gradient from `background` at the bottom; empty: one colour
    std::string background_image;  ///< PNG file beside the scene that fills the picture; empty: none
    std::string ground = "#8d9096";
    std::string ground_texture;  ///< PNG file beside the scene, repeated; empty: one colour
    double ground_scale = 1;     ///< m of the ground that the picture spans
    bool horizon = false;        ///< the ground goes on to the horizon, not only to a little beyond the scene
    std::string solid = "#c9b79c";
    bool show_ground = true;
    std::optional<double> ground_height;  ///< m; absent: under the lowest plane or a little under everything
    Show show = Show::components;
    double show_max = 0;  ///< where the scale of strain (1) or velocity [m/s] ends; 0: by the clip
    Theme theme = Theme::dark;
    bool legend = false;       ///< tell in the picture what its colours mean
    bool transparent = false;  ///< no ground, no background: frames with an alpha channel
    int subdivide = -1;  ///< times that each cell is drawn as four smooth ones; −1: as a coarse grid needs it
    int motion_blur = 1;   ///< sub-frames that a picture is the mean of; 1: none
    double shutter = 0.5;  ///< share of the time between frames that the shutter is open before each
};

/// The whole scene. Gravity is present unless the scene says `gravity = [0, 0, 0]`.
struct Scene {
    std::string name;                  ///< file name without its ending
    std::string text;                  ///< the file as read
    std::string root;                  ///< folder of the files that it names, from its own; empty: its own
    std::vector<std::string> include;  ///< scene files whose tables it takes over
    std::filesystem::path home;        ///< that folder as the loader found it
    std::vector<std::string> notes;    ///< what the loader passed over, mended or asks about
    Clip clip;
    Vec3 gravity{0, -9.81, 0};  ///< m/s²
    std::vector<Cloth> cloths;
    std::vector<Solid> solids;
    Solver solver;
    std::optional<Wind> wind;
    std::optional<SelfCollision> self_collision;
    std::vector<Camera> cameras;  ///< at least one after loading
    Look look;
};

}  // namespace unravel::sim
