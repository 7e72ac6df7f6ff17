#include "tool/picture/subdivision.hpp"

#include <algorithm>

namespace unravel::tool {

namespace {

// Catmull & Rom 1974, between b and c at t in [0, 1].
Vec3f between(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d, float t) {
    const float t2 = t * t, t3 = t2 * t;
    return 0.5f *
           ((-t3 + 2 * t2 - t) * a + (3 * t3 - 5 * t2 + 2) * b + (-3 * t3 + 4 * t2 + t) * c + (t3 - t2) * d);
}

// Points along a line of `count` given ones, each interval in `factor` parts. Beyond an open line's ends it
// goes on straight. `at` gives a point, `put` takes the result.
template <class At, class Put>
void refine(int count, bool closed, int factor, At&& at, Put&& put) {
    const auto point = [&](int i) -> Vec3f {
        if (closed) return at((i + count) % count);
        if (i < 0) return 2 * at(0) - at(std::min(1, count - 1));
        if (i >= count) return 2 * at(count - 1) - at(std::max(count - 2, 0));
        return at(i);
    };
    const int intervals = closed ? count : count - 1;
    for (int i = 0; i < intervals; ++i) {
        const Vec3f a = point(i - 1), b = point(i), c = point(i + 1), d = point(i + 2);
        for (int k = 0; k < factor; ++k)
            put(i * factor + k, between(a, b, c, d, static_cast<float>(k) / static_cast<float>(factor)));
    }
    if (!closed) put(intervals * factor, point(intervals));
}

}  // namespace

int display_level(const Look& look, const ClothPatch& patch) {
    // Cells of this many fill a picture without being told apart.
    constexpr int enough = 6000, most = 2;
    if (!patch.grid()) return 0;  // a mesh is shown as it is
    if (look.subdivide >= 0) return look.subdivide;
    int level = 0;
    while (level < most && (patch.cells_u() * patch.cells_v() << (2 * level)) < enough) ++level;
    return level;
}

FineGrid::FineGrid(const ClothPatch& patch, int level)
    : patch_(&patch),
      factor_(1 << level),
      columns_(patch.cells_u() * factor_ + (patch.tube ? 0 : 1)),
      rows_(patch.cells_v() * factor_ + 1),
      rows_refined_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(patch.particles[1])) {}

void FineGrid::points(std::span<const Vec3f> particles, std::span<Vec3f> out) {
    const auto columns = static_cast<std::size_t>(columns_);
    const int nu = patch_->particles[0], nv = patch_->particles[1];
    for (int j = 0; j < nv; ++j)
        refine(
            nu, patch_->tube, factor_, [&](int i) { return particles[patch_->at(i, j)]; },
            [&](int i, const Vec3f& x) {
                rows_refined_[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)] = x;
            });
    for (std::size_t i = 0; i < columns; ++i)
        refine(
            nv, false, factor_,
            [&](int j) { return rows_refined_[static_cast<std::size_t>(j) * columns + i]; },
            [&](int j, const Vec3f& x) { out[static_cast<std::size_t>(j) * columns + i] = x; });
}

void FineGrid::colors(std::span<const Rgb> particles, std::span<Rgb> out) const {
    const int half = factor_ / 2;
    for (int j = 0; j < rows_; ++j)
        for (int i = 0; i < columns_; ++i)
            out[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(i)] =
                particles[patch_->at((i + half) / factor_, (j + half) / factor_)];
}

}  // namespace unravel::tool
