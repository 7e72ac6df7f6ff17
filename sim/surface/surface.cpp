#include "sim/surface/surface.hpp"

#include <algorithm>
#include <numeric>

namespace unravel::sim {

namespace {

// Numbers of the features that each particle is a corner of, in order.
template <typename Features>
Lists features_at(std::size_t particles, const Features& features) {
    Lists out;
    out.start.assign(particles + 1, 0);
    for (const auto& corners : features) {
        for (const std::uint32_t p : corners) ++out.start[p + 1];
    }
    for (std::size_t p = 0; p < particles; ++p) out.start[p + 1] += out.start[p];
    out.list.resize(out.start.back());
    std::vector<std::uint32_t> next(out.start.begin(), out.start.end() - 1);
    for (std::uint32_t k = 0; k < features.size(); ++k) {
        for (const std::uint32_t p : features[k]) out.list[next[p]++] = k;
    }
    return out;
}

}  // namespace

void SurfaceBuilder::begin_cloth(std::uint32_t first, std::uint32_t count) {
    const std::uint32_t number = out_.cloth.empty() ? 0 : out_.cloth.back() + 1;
    out_.cloth.resize(first + count, number);
}

void SurfaceBuilder::add_grid(std::uint32_t first, int nu, int nv, bool tube) {
    begin_cloth(first, static_cast<std::uint32_t>(nu) * static_cast<std::uint32_t>(nv));
    const auto at = [&](int i, int j) {
        return first + static_cast<std::uint32_t>(j) * static_cast<std::uint32_t>(nu) +
               static_cast<std::uint32_t>(i % nu);
    };
    const int cells_u = tube ? nu : nu - 1;
    for (int j = 0; j + 1 < nv; ++j) {
        for (int i = 0; i < cells_u; ++i) {
            const std::uint32_t a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1), d = at(i + 1, j);
            if ((i + j) % 2 == 0) {
                out_.triangles.push_back({a, b, c});
                out_.triangles.push_back({a, c, d});
            } else {
                out_.triangles.push_back({a, b, d});
                out_.triangles.push_back({b, c, d});
            }
        }
    }
    if (nv == 1 && nu > 1) {
        for (int i = 0; i < cells_u; ++i)
            out_.edges.push_back({std::min(at(i, 0), at(i + 1, 0)), std::max(at(i, 0), at(i + 1, 0))});
    }
    if (nu == 1) {
        for (int j = 0; j + 1 < nv; ++j) out_.edges.push_back({at(0, j), at(0, j + 1)});
    }
}

void SurfaceBuilder::add_mesh(std::uint32_t first, std::uint32_t count) {
    begin_cloth(first, count);
}

void SurfaceBuilder::add_face(std::span<const std::uint32_t> corners) {
    for (std::size_t k = 2; k < corners.size(); ++k)
        out_.triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

void SurfaceBuilder::sew(std::uint32_t p, std::uint32_t q) {
    seams_.push_back({p, q});
}

Surface SurfaceBuilder::build() {
    Surface out = std::move(out_);
    for (const auto& [a, b, c] : out.triangles) {
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            out.edges.push_back({std::min(p, q), std::max(p, q)});
    }
    std::sort(out.edges.begin(), out.edges.end());
    out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
    out.sides.assign(out.edges.size(), {Surface::none, Surface::none});
    for (std::uint32_t t = 0; t < out.triangles.size(); ++t) {
        const auto& [a, b, c] = out.triangles[t];
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
            const std::array<std::uint32_t, 2> edge{std::min(p, q), std::max(p, q)};
            const auto e = std::lower_bound(out.edges.begin(), out.edges.end(), edge) - out.edges.begin();
            std::array<std::uint32_t, 2>& side = out.sides[static_cast<std::size_t>(e)];
            (side[0] == Surface::none ? side[0] : side[1]) = t;
        }
    }
    for (const auto& [a, b] : out.edges) out.vertices.insert(out.vertices.end(), {a, b});
    std::sort(out.vertices.begin(), out.vertices.end());
    out.vertices.erase(std::unique(out.vertices.begin(), out.vertices.end()), out.vertices.end());
    out.triangles_at = features_at(out.particles(), out.triangles);
    out.edges_at = features_at(out.particles(), out.edges);
    out.joint.resize(out.particles());
    std::iota(out.joint.begin(), out.joint.end(), 0u);
    const auto root = [&](std::uint32_t p) {
        while (out.joint[p] != p) p = out.joint[p];
        return p;
    };
    for (const auto& [p, q] : seams_) {
        const std::uint32_t a = root(p), b = root(q);
        out.joint[std::max(a, b)] = std::min(a, b);
    }
    for (std::uint32_t p = 0; p < out.joint.size(); ++p) out.joint[p] = root(p);
    out_ = {};
    seams_.clear();
    return out;
}

}  // namespace unravel::sim
