#include "sim/model/mesh_links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/mesh/mesh_cloth.hpp"

namespace unravel::sim {

namespace {

constexpr std::size_t most_neighbours = 1024;
constexpr double far_away = std::numeric_limits<double>::infinity();

// Links of one mesh with their lengths along it.
struct Links {
    struct Link {
        std::uint32_t to;
        double length;
        std::uint8_t hops;  // a seam takes none
    };
    std::vector<std::uint32_t> start;
    std::vector<Link> list;

    explicit Links(const MeshCloth& mesh) {
        struct Joined {
            std::uint32_t a, b;
            double length;
            std::uint8_t hops;
        };
        std::vector<Joined> pairs;
        const auto add = [&](std::uint32_t a, std::uint32_t b) {
            pairs.push_back({a, b, (mesh.rest[b] - mesh.rest[a]).norm(), 1});
        };
        for (const MeshCloth::Edge& edge : mesh.edges) add(edge.a, edge.b);
        for (const MeshCloth::Cell& cell : mesh.cells) {
            if (cell.corners != 4) continue;
            add(cell.vertex[0], cell.vertex[2]);
            add(cell.vertex[1], cell.vertex[3]);
        }
        for (const auto& [a, b] : mesh.seams) pairs.push_back({a, b, 0.0, 0});
        start.assign(mesh.rest.size() + 1, 0);
        for (const Joined& pair : pairs) {
            ++start[pair.a + 1];
            ++start[pair.b + 1];
        }
        for (std::size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
        list.resize(start.back());
        std::vector<std::uint32_t> place(start.begin(), start.end() - 1);
        for (const Joined& pair : pairs) {
            list[place[pair.a]++] = {pair.b, pair.length, pair.hops};
            list[place[pair.b]++] = {pair.a, pair.length, pair.hops};
        }
    }
};

// Searches around one vertex after another; the marks keep their memory.
class Search {
public:
    Search(const Links& links, double reach) : links_(links), reach_(reach) {
        hops_.assign(links.start.size() - 1, 0xFF);
        way_.assign(links.start.size() - 1, far_away);
    }

    const std::vector<std::uint32_t>& around(std::uint32_t from) {
        for (const std::uint32_t v : touched_) {
            hops_[v] = 0xFF;
            way_[v] = far_away;
        }
        touched_.assign(1, from);
        hops_[from] = 0;
        way_[from] = 0;
        // Whoever is reached by fewer hops or a shorter way than before is looked at again: the sets are
        // small.
        queue_.assign(1, from);
        for (std::size_t k = 0; k < queue_.size() && touched_.size() < most_neighbours; ++k) {
            const std::uint32_t v = queue_[k];
            for (std::uint32_t l = links_.start[v]; l < links_.start[v + 1]; ++l) visit(v, links_.list[l]);
        }
        found_ = touched_;
        std::sort(found_.begin(), found_.end());
        return found_;
    }

private:
    void visit(std::uint32_t v, const Links::Link& link) {
        const int hops = std::min(hops_[v] + link.hops, 0xFE);
        const double way = way_[v] + link.length;
        const bool fewer = hops < hops_[link.to] && hops <= 2, shorter = way < way_[link.to] && way <= reach_;
        if (!fewer && !shorter) return;
        if (hops_[link.to] == 0xFF && way_[link.to] == far_away) touched_.push_back(link.to);
        hops_[link.to] = static_cast<std::uint8_t>(std::min<int>(hops, hops_[link.to]));
        way_[link.to] = std::min(way, way_[link.to]);
        queue_.push_back(link.to);
    }

    const Links& links_;
    double reach_;
    std::vector<std::uint8_t> hops_;
    std::vector<double> way_;
    std::vector<std::uint32_t> touched_, queue_, found_;
};

}  // namespace

double typical_spacing(const MeshCloth& mesh) {
    std::vector<double> lengths;
    lengths.reserve(mesh.edges.size());
    for (const MeshCloth::Edge& edge : mesh.edges) lengths.push_back(mesh.length(edge));
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
}

void add_stitches(const Cloth& cloth, const ClothPatch& patch, const Placement& placement,
                  ClothModel& model) {
    double stiffness = cloth.sewing.stiffness;
    if (stiffness == 0) {
        for (std::size_t s = 0; s < model.springs.stretch_count; ++s) {
            const std::uint32_t p = model.springs.i[s];
            if (p >= patch.first && p < patch.first + patch.count())
                stiffness = std::max(stiffness, model.springs.stiffness[s]);
        }
    }
    for (const auto& [a, b] : patch.mesh->seams) {
        const std::uint32_t p = patch.first + a, q = patch.first + b;
        Stitches& out = model.stitches;
        out.i.push_back(p);
        out.j.push_back(q);
        out.start.push_back((placement.x[q] - placement.x[p]).norm());
        out.stiffness.push_back(stiffness);
        out.damping.push_back(0.2 * 2.0 * std::sqrt(stiffness * std::min(model.mass[p], model.mass[q])));
        out.closed.push_back(cloth.sewing.time);
    }
}

void find_mesh_neighbours(ClothModel& model) {
    Neighbours& out = model.neighbours;
    const auto is_mesh = [](const ClothPatch& patch) { return !patch.grid(); };
    if (std::none_of(model.cloths.begin(), model.cloths.end(), is_mesh)) return;
    out.start.assign(1, 0);
    for (const ClothPatch& patch : model.cloths) {
        if (patch.grid()) {
            out.start.resize(out.start.size() + patch.count(), out.start.back());
            continue;
        }
        const Links links(*patch.mesh);
        Search search(links, model.self_collision->thickness);
        for (std::uint32_t v = 0; v < patch.count(); ++v) {
            for (const std::uint32_t w : search.around(v)) out.list.push_back(patch.first + w);
            out.start.push_back(static_cast<std::uint32_t>(out.list.size()));
        }
    }
}

}  // namespace unravel::sim
