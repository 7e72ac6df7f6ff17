#include "sim/step/explicit_limit.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/forces/curvature_split.hpp"
#include "sim/integrators/scheme.hpp"
#include "sim/mesh/mesh_cloth.hpp"

namespace unravel::sim {

namespace {

// Share of the limit of stability that a substep chosen here may reach. The limit is that of the cloth laid
// flat; air, bending and stretched cells take their part: a hanging sheet of 201 × 201 breaks at 0.9 and is
// as with substeps half as long at 0.75.
constexpr double limit_margin = 0.75;

std::size_t patch_of(const ClothModel& model, std::uint32_t p) {
    std::size_t c = 0;
    while (p >= model.cloths[c].first + model.cloths[c].count()) ++c;
    return c;
}

// Direction of a spring in the plane that touches a mesh at vertex p.
Vec2 tangent_direction(const MeshCloth& mesh, const std::vector<Vec3>& normals, std::uint32_t p,
                       std::uint32_t i, std::uint32_t j) {
    const Vec3& n = normals[p];
    const Vec3 a = n.unitOrthogonal(), d = mesh.rest[j] - mesh.rest[i];
    const Vec2 in_plane(a.dot(d), n.cross(a).dot(d));
    const double length = in_plane.norm();
    return length > 0 ? Vec2(in_plane / length) : Vec2(1, 0);
}

// Unit normals at the vertices of a mesh at rest.
std::vector<Vec3> rest_normals(const MeshCloth& mesh) {
    std::vector<Vec3> normals(mesh.rest.size(), Vec3::Zero());
    for (const MeshCloth::Cell& cell : mesh.cells) {
        const auto x = [&](std::size_t k) { return mesh.rest[cell.vertex[k]]; };
        const Vec3 n =
            cell.corners == 4 ? (x(2) - x(0)).cross(x(3) - x(1)) : (x(1) - x(0)).cross(x(2) - x(0));
        for (std::size_t k = 0; k < cell.corners; ++k) normals[cell.vertex[k]] += n;
    }
    for (Vec3& n : normals) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3::UnitY();
    return normals;
}

// Direction of a spring on the flat cloth.
Vec2 flat_direction(const ClothModel& model, std::uint32_t i, std::uint32_t j) {
    const ClothPatch& patch = model.cloths[patch_of(model, i)];
    const int nu = patch.particles[0], a = static_cast<int>(i - patch.first),
              b = static_cast<int>(j - patch.first);
    int du = b % nu - a % nu;
    if (patch.tube && std::abs(du) > 1) du = du > 0 ? -1 : 1;  // over the seam
    const Vec2 d(du * patch.size[0] / std::max(patch.cells_u(), 1),
                 (b / nu - a / nu) * patch.size[1] / std::max(patch.cells_v(), 1));
    return d.normalized();
}

double larger_eigenvalue(const Eigen::Matrix2d& A) {
    const double mean = 0.5 * A.trace(), half = 0.5 * (A(0, 0) - A(1, 1));
    return mean + std::hypot(half, A(0, 1));
}

}  // namespace

double stable_substeps(double h, double stable) {
    return std::max(1.0, std::ceil(h / (limit_margin * stable) - 1e-9));
}

namespace {

// What is explicit at each particle, apart from the step that bears it.
class ExplicitParts {
public:
    // As split for a step of h seconds.
    ExplicitParts(const ClothModel& model, const StepOptions& options, double h)
        : model_(model),
          splitting_(splitting_of(options)),
          bound_(scheme_of(options.integrator).explicit_bound),
          stiffness_(model.size(), Eigen::Matrix2d::Zero()),
          damping_(model.size(), Eigen::Matrix2d::Zero()),
          kappa_(model.size(), 0.0),
          held_(model.size(), 0) {
        // What is pinned for good does not swing.
        for (const PinnedGroup& pin : model.pins) {
            for (const std::uint32_t p : pin.particles)
                held_[p] = !std::isfinite(pin.release) && !pin.slides();
        }
        add_springs(h);
        split_bending(h);
    }

    // (h²λ + 2hμ)/bound at a particle, of a step of h seconds; 0 where it is held.
    double share(std::uint32_t p, double h) const {
        if (held_[p] != 0) return 0;
        const double springs = larger_eigenvalue(h * h * stiffness_[p] + 2 * h * damping_[p]);
        return (2 * springs / model_.mass[p] + h * h * bending_[p]) / bound_;
    }
    // Largest κ there, as split.
    double kappa(std::uint32_t p, double h) const { return std::max(kappa_[p], h * h * bending_[p] / 8); }

    // The largest share, and the first particle that has it.
    ExplicitLimit worst(double h) const {
        ExplicitLimit out;
        for (std::uint32_t p = 0; p < model_.size(); ++p) {
            const double here = share(p, h);
            if (here > out.share) out = {here, p, kappa(p, h), 0};
        }
        return out;
    }

    // The largest step between two that nowhere takes the whole share, by so many halvings.
    double largest_step(double low, double high, int halvings) {
        if (bending_follows_step()) {
            return bisect(low, high, halvings, [&](double h) {
                split_bending(h);
                return worst(h).share < 1;
            });
        }
        // Most particles are like others: each is asked whether it bears what those before it do.
        double step = high;
        for (std::uint32_t p = 0; p < model_.size(); ++p) {
            if (step == low || share(p, step) < 1) continue;
            step = bisect(low, high, halvings, [&](double h) { return share(p, h) < 1; });
        }
        return step;
    }

private:
    template <typename F>
    static double bisect(double low, double high, int halvings, const F& bears) {
        for (int k = 0; k < halvings; ++k) {
            const double middle = 0.5 * (low + high);
            (bears(middle) ? low : high) = middle;
        }
        return low;
    }

    bool bending_follows_step() const {
        return splitting_.bend_threshold > always_implicit && splitting_.bend_threshold < always_explicit;
    }

    void add_springs(double h) {
        std::vector<std::vector<Vec3>> normals(model_.cloths.size());
        for (std::size_t c = 0; c < normals.size(); ++c) {
            if (!model_.cloths[c].grid()) normals[c] = rest_normals(*model_.cloths[c].mesh);
        }
        for (std::uint32_t s = 0; s < model_.springs.size(); ++s) {
            const std::uint32_t i = model_.springs.i[s], j = model_.springs.j[s];
            const double k = model_.springs.stiffness[s], d = model_.springs.damping[s];
            const double of_spring = kappa_between(h, model_.mass[i], model_.mass[j], k, d);
            if (!is_explicit(of_spring, splitting_.threshold(s < model_.springs.stretch_count))) continue;
            const std::size_t c = patch_of(model_, i);
            const bool grid = model_.cloths[c].grid();
            const std::uint32_t first = model_.cloths[c].first;
            Vec2 u = grid ? flat_direction(model_, i, j) : Vec2::Zero();
            for (const std::uint32_t p : {i, j}) {
                if (!grid)
                    u = tangent_direction(*model_.cloths[c].mesh, normals[c], p - first, i - first,
                                          j - first);
                const Eigen::Matrix2d along = u * u.transpose();
                stiffness_[p] += k * along;
                damping_[p] += d * along;
                kappa_[p] = std::max(kappa_[p], of_spring);
            }
        }
    }

    void split_bending(double h) {
        const auto implicit =
            implicit_curvature(model_.curvature, model_.springs, model_.mass, h, splitting_);
        bending_ =
            curvature_bounds(model_.curvature, model_.mass, [&](std::size_t s) { return implicit[s] == 0; });
    }

    const ClothModel& model_;
    Splitting splitting_;
    double bound_;
    std::vector<Eigen::Matrix2d> stiffness_, damping_;  // (particles) K_i [N/m] and D_i [N·s/m] in the plane
    std::vector<double> kappa_;                         // (particles) largest κ of a spring
    std::vector<double> bending_;                       // (particles) bound of bending's λ [1/s²]
    std::vector<char> held_;
};

}  // namespace

ExplicitLimit explicit_limit(const ClothModel& model, const StepOptions& options, double h) {
    ExplicitParts parts(model, options, h);
    ExplicitLimit limit = parts.worst(h);
    limit.step = std::numeric_limits<double>::infinity();
    const Splitting splitting = splitting_of(options);
    const bool follows_step = splitting.stretch_threshold < always_explicit &&
                              splitting.shear_threshold < always_explicit &&
                              splitting.bend_threshold < always_explicit;
    if (limit.share == 0 || follows_step) return limit;
    // The share grows with the step: at least linearly, at most as its square.
    limit.step = parts.largest_step(h / std::max(1.0, limit.share), h * std::max(1.0, 1.0 / limit.share), 40);
    return limit;
}

void require_explicit_stability(const ClothModel& model, const StepOptions& options, double h) {
    if (options.integrator == Integrator::automatic) return;  // whichever it takes is stable
    if (options.integrator == Integrator::explicit_) {
        if (options.substeps == 0) {
            const double stable = explicit_limit(model, options, h).step, count = stable_substeps(h, stable);
            if (count <= most_substeps) return;
            throw UnstableStep(
                fmt::format("explicit would have to divide each step of {:.4g} s into {:.3g} substeps of "
                            "{:.3g} s (at most {:.0f}); take solver.integrator = \"adaptive-imex\"",
                            h, count, h / count, most_substeps));
        }
        h /= options.substeps;
    }
    const ExplicitLimit limit = explicit_limit(model, options, h);
    if (limit.share < 1) return;
    const std::string fault = fmt::format(
        "what is handled explicitly at particle {} reaches kappa = {:.3g} (Eq. 7): {:.3g} times what a "
        "step "
        "of {:.4g} s bears",
        limit.particle, limit.kappa, limit.share, h);
    if (std::isfinite(limit.step)) {
        throw UnstableStep(
            fmt::format("{}; the largest stable step is {:.3g} s; solver.substeps = 0 divides each step "
                        "until it is stable, "
                        "solver.integrator = \"adaptive-imex\" bears it whole",
                        fault, limit.step));
    }
    throw UnstableStep(fmt::format("{}; take a solver.threshold of 0.5 or less", fault));
}

}  // namespace unravel::sim
