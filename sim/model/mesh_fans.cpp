#include "sim/model/mesh_fans.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace unravel::sim {

namespace {

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

FanWalk::FanWalk(const MeshCloth& mesh) : mesh_(mesh), start_(mesh.rest.size() + 1, 0) {
    for (const MeshCloth::Cell& cell : mesh.cells) {
        for (std::size_t k = 0; k < cell.corners; ++k) ++start_[cell.vertex[k] + 1];
    }
    for (std::size_t v = 1; v < start_.size(); ++v) start_[v] += start_[v - 1];
    wedges_.resize(start_.back());
    std::vector<std::uint32_t> place(start_.begin(), start_.end() - 1);
    for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
        const MeshCloth::Cell& cell = mesh.cells[c];
        for (std::size_t k = 0; k < cell.corners; ++k) {
            wedges_[place[cell.vertex[k]]++] = {cell.vertex[(k + 1) % cell.corners],
                                                cell.vertex[(k + cell.corners - 1u) % cell.corners], c};
        }
    }
}

Fan FanWalk::take_fan(std::uint32_t v, std::vector<Wedge>& left) const {
    // A border's fan begins with the wedge that no other leads to.
    auto first = std::find_if(left.begin(), left.end(), [&](const Wedge& w) {
        return std::none_of(left.begin(), left.end(),
                            [&](const Wedge& other) { return other.previous == w.next; });
    });
    Fan fan;
    fan.closed = first == left.end();
    if (fan.closed) first = left.begin();
    const std::uint32_t origin = first->next;
    for (auto wedge = first; wedge != left.end();) {
        add(v, *wedge, fan);
        const std::uint32_t onward = wedge->previous;
        left.erase(wedge);
        wedge = std::find_if(left.begin(), left.end(), [&](const Wedge& w) { return w.next == onward; });
        if (wedge == left.end() && onward != origin)
            fan.spokes.push_back({onward, fan.whole, (mesh_.rest[onward] - mesh_.rest[v]).norm(), false});
    }
    return fan;
}

void FanWalk::add(std::uint32_t v, const Wedge& wedge, Fan& fan) const {
    const Vec3 &x = mesh_.rest[v], from = mesh_.rest[wedge.next] - x, to = mesh_.rest[wedge.previous] - x;
    fan.spokes.push_back({wedge.next, fan.whole, from.norm(), false});
    fan.cells.push_back(wedge.cell);
    const MeshCloth::Cell& cell = mesh_.cells[wedge.cell];
    if (cell.corners == 3) {
        fan.whole += angle_between(from, to);
        return;
    }
    fan.quads = true;
    std::uint32_t far = no_index;
    for (const std::uint32_t corner : cell.vertex) {
        if (corner != v && corner != wedge.next && corner != wedge.previous) far = corner;
    }
    const Vec3 across = mesh_.rest[far] - x;
    fan.whole += angle_between(from, across);
    fan.spokes.push_back({far, fan.whole, across.norm(), true});
    fan.whole += angle_between(across, to);
}

}  // namespace unravel::sim
