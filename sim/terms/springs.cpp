#include "sim/terms/springs.hpp"

#include <algorithm>

#include "sim/mesh/mesh_cloth.hpp"
#include "sim/terms/measure.hpp"
#include "sim/terms/row_version.hpp"
#include "sim/terms/terms.hpp"

namespace unravel::sim {

namespace {

void evaluate_springs(const ClothModel& model, const ForcesAt& at, ForceMemory& memory) {
    extension_forces(model.springs, model.mass, at.x, at.v, at.settings.h, at.settings.splitting,
                     at.settings.band, memory.springs, at.taut, at.ahead);
}

void add_springs(const ClothModel& model, const ForceMemory& memory, std::span<Vec3> force) {
    add_by_spring(model.spring_adjacency, memory.springs.force, force);
}

// Their line is found anew from where they are linearised: rows keep none.
void couple_springs(const ClothModel& model, const ForcesAt& at, const ForceMemory& memory,
                    StepCouplings& out) {
    out.springs.push_back({&model.springs, &model.spring_adjacency, &memory.springs, {}, at.linearised_at()});
}

void add_springs_of_row(const RowPass& pass, std::size_t row) {
    each_family(pass, row, extension_families,
                [&](std::size_t k, const RowState& a, const RowState& b, std::size_t count, const Row& fa,
                    const Row& fb) {
                    const GridTables::Extension& t = pass.tables.extension[k];
                    if (!t.any) return;
                    extension_row(a, b, t.rest, t.stiffness.row(row), t.damping.row(row), count, fa, fb);
                });
}
const RowVersion spring_rows{.reach = 1, .present = nullptr, .add = add_springs_of_row, .splits = true};

void measure_springs(const ClothModel& model, std::span<const Vec3> x, const ForceMemory&,
                     MeasureWorkspace& ws, StepReport& report) {
    const ExtensionSprings& springs = model.springs;
    ws.strain.resize(springs.stretch_count);
    report.potential += ws.sum(springs.size(), [&](std::size_t s) {
        const double length = (x[springs.j[s]] - x[springs.i[s]]).norm();
        if (s < springs.stretch_count)
            ws.strain[s] = static_cast<float>(spring_strain(length, springs.rest[s]));
        return extension_energy(length, springs.rest[s], springs.stiffness[s]);
    });
    if (ws.strain.empty()) return;
    report.strained = static_cast<std::uint32_t>(std::ranges::max_element(ws.strain) - ws.strain.begin());
    report.max_strain = ws.strain[report.strained];
    const auto p99 =
        ws.strain.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(ws.strain.size() - 1));
    std::nth_element(ws.strain.begin(), p99, ws.strain.end());
    report.p99_strain = *p99;
}

double gain_of_explicit(const ClothModel& model, const StepEnds& step, const ForceMemory&,
                        MeasureWorkspace& ws) {
    const ExtensionSprings& springs = model.springs;
    return ws.sum(springs.size(), [&](std::size_t s) {
        const std::uint32_t i = springs.i[s], j = springs.j[s];
        const double rest = springs.rest[s], stiffness = springs.stiffness[s];
        const double of_spring =
            kappa_between(step.settings.h, model.mass[i], model.mass[j], stiffness, springs.damping[s]);
        if (!is_explicit(of_spring, step.settings.splitting.threshold(s < springs.stretch_count))) return 0.0;
        const Vec3 d = step.x[j] - step.x[i], d_next = step.x_next[j] - step.x_next[i];
        const double length = d.norm();
        double gain = extension_energy(d_next.norm(), rest, stiffness);
        if (is_taut(length, rest)) {
            gain -= extension_energy(length, rest, stiffness) +
                    spring_pull(stiffness, length - rest, 0, 0).elastic / length * d.dot(d_next - d);
        }
        return gain;
    });
}

bool resists_shear(const Cloth& cloth) {
    if (cloth.geometry) {
        return cloth.material.shear > 0 &&
               std::ranges::any_of(cloth.geometry->cells, [](const auto& cell) { return cell.corners == 4; });
    }
    double most = cloth.material.shear;
    for (const Region& region : cloth.regions)
        most = region.material ? std::max(most, region.material->shear) : most;
    return cloth.particles[0] > 1 && cloth.particles[1] > 1 && most > 0;
}

void list_springs(const Scene& scene, std::vector<Effect>& effects) {
    const bool stretch = std::ranges::any_of(scene.cloths, [](const Cloth& cloth) {
        return cloth.geometry || cloth.particles[0] * cloth.particles[1] > 1;
    });
    const bool shear = std::ranges::any_of(scene.cloths, resists_shear);
    effects.push_back({"stretch", stretch,
                       stretch ? "cloth: " + names_of(scene.cloths) : "every cloth is a single particle"});
    effects.push_back(
        {"shear", shear, shear ? "a cloth has shear stiffness" : "no cloth has shear stiffness"});
}

}  // namespace

const ForceTerm spring_term{.name = "stretch and shear",
                            .acts = [](const ClothModel& model) { return model.springs.size() > 0; },
                            .evaluate = evaluate_springs,
                            .add = add_springs,
                            .couple = couple_springs,
                            .may_be_implicit = [](const ClothModel&, const ForceSettings&) { return true; },
                            .rows = &spring_rows,
                            .measure = measure_springs,
                            .explicit_gain = gain_of_explicit,
                            .effects = list_springs};

}  // namespace unravel::sim
