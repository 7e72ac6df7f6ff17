#include <algorithm>
#include <limits>

#include "sim/constraints/contact.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/solids/shape.hpp"

namespace unravel::sim {

namespace {

SolidReach reach_of(const Solid& solid, const Pose& now, const Pose& next) {
    SolidReach reach;
    reach.now = now.translation();
    reach.next = next.translation();
    reach.normal = now.linear().col(1);
    reach.radius = law_of(solid.shape).reach(solid);
    reach.plane = solid.shape == Shape::plane && !solid.moves();
    reach.travel = (reach.next - reach.now).norm();
    // Frobenius' norm of the difference is 2√2 sin(θ/2): more than θ for turns below 2.2, and at most 2√2.
    reach.turn = std::min((next.linear() - now.linear()).norm(), 1.0);
    reach.skin = (1.0 + open_share) * solid.offset;
    return reach;
}

}  // namespace

void pose_solids(std::span<const Solid> solids, double t, double h, SolidPoses& out) {
    out.now.clear();
    out.next.clear();
    out.reach.clear();
    for (const Solid& solid : solids) {
        out.now.push_back(solid_pose(solid, t));
        out.next.push_back(solid_pose(solid, t + h));
        out.reach.push_back(reach_of(solid, out.now.back(), out.next.back()));
    }
    const auto deforms = [](const Solid& solid) { return solid.geometry && solid.geometry->deforms(); };
    if (std::none_of(solids.begin(), solids.end(), deforms)) return;
    out.deformed.resize(solids.size());
    for (std::size_t s = 0; s < solids.size(); ++s) {
        if (!deforms(solids[s])) continue;
        const MeshSolid& mesh = *solids[s].geometry;
        DeformedSolid& body = out.deformed[s];
        if (body.now.empty()) body.now = body.next = mesh.tree;
        std::swap(body.now, body.next);
        std::swap(body.positions_now, body.positions_next);
        if (body.t_next != t) {
            mesh.positions_at(t, body.positions_now);
            body.now.refit(body.positions_now);
        }
        mesh.positions_at(t + h, body.positions_next);
        body.next.refit(body.positions_next);
        body.t_next = t + h;
        body.moved = 0;
        for (std::size_t v = 0; v < body.positions_now.size(); ++v)
            body.moved = std::max(body.moved, (body.positions_next[v] - body.positions_now[v]).norm());
    }
}

const DeformedSolid* SolidPoses::of(const Solid& solid, std::size_t index) const {
    return solid.geometry && solid.geometry->deforms() ? &deformed[index] : nullptr;
}

}  // namespace unravel::sim
