#include "sim/mesh/cut_polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace unravel::sim {

namespace {

// A quad is cut off where its angles differ from a right one by no more than this, as triangles are paired to
// cells (mesh_cloth.cpp).
constexpr double most_quad_skew = 25.0 * std::numbers::pi / 180.0;

constexpr double not_allowed = std::numeric_limits<double>::infinity();

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

// The polygon as seen along its mean normal (Newell's), counter-clockwise.
std::vector<Vec2> flattened(std::span<const Vec3> corners) {
    Vec3 normal(0, 0, 0), along(0, 0, 0);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 a = corners[k] - corners[0], b = corners[(k + 1) % corners.size()] - corners[0];
        normal += a.cross(b);
        if ((b - a).squaredNorm() > along.squaredNorm()) along = b - a;
    }
    if (!(normal.norm() > 0)) normal = along.unitOrthogonal();
    normal.normalize();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Vec2> out;
    out.reserve(corners.size());
    for (const Vec3& x : corners) out.emplace_back(u.dot(x - corners[0]), v.dot(x - corners[0]));
    return out;
}

class PolygonCut {
public:
    explicit PolygonCut(std::span<const Vec3> corners)
        : at_(flattened(corners)), left_(corners.size()), next_(left_), before_(left_), cost_(left_) {
        for (std::uint32_t k = 0; k < left_; ++k) {
            next_[k] = (k + 1) % static_cast<std::uint32_t>(left_);
            before_[next_[k]] = k;
        }
        for (std::uint32_t k = 0; k < left_; ++k) judge(k);
    }

    std::vector<Piece> cut() {
        std::vector<Piece> pieces;
        std::uint32_t any = 0;
        while (left_ >= 3) {
            any = cut_best(any, pieces);
        }
        return pieces;
    }

private:
    // Costs of cutting off the triangle and the quad that begin at a corner.
    struct Cost {
        double triangle = not_allowed, quad = not_allowed;
        double least() const { return std::min(triangle, quad); }
    };

    Piece piece_at(std::uint32_t a, std::size_t count) const {
        const std::uint32_t b = next_[a], c = next_[b];
        return {a, b, c, count == 4 ? next_[c] : no_index};
    }

    // Angle at a corner of a piece; no angle where it does not turn left.
    double angle(const Piece& piece, std::size_t count, std::size_t k) const {
        const Vec2& x = at_[piece[k]];
        const Vec2 to = at_[piece[(k + 1) % count]] - x, from = at_[piece[(k + count - 1) % count]] - x;
        const double turn = cross(to, from);
        return turn > 1e-9 * to.norm() * from.norm() ? std::atan2(turn, to.dot(from)) : not_allowed;
    }

    // The largest difference of an angle from that of an even piece.
    double skew(const Piece& piece, std::size_t count) const {
        const double even = count == 4 ? std::numbers::pi / 2 : std::numbers::pi / 3;
        double worst = 0;
        for (std::size_t k = 0; k < count; ++k)
            worst = std::max(worst, std::abs(angle(piece, count, k) - even));
        return worst;
    }

    // Whether another corner lies in the piece or on its border, but for those at its own corners' places
    // (where a polygon with a hole runs to and fro along a bridge).
    bool holds_another(const Piece& piece, std::size_t count) const {
        std::uint32_t k = next_[piece[count - 1]];
        for (; k != piece[0]; k = next_[k]) {
            bool inside = true;
            for (std::size_t c = 0; c < count && inside; ++c) {
                const Vec2 &a = at_[piece[c]], &b = at_[piece[(c + 1) % count]];
                inside = at_[k] != a && cross(b - a, at_[k] - a) >= 0;
            }
            if (inside) return true;
        }
        return false;
    }

    void judge(std::uint32_t a) {
        cost_[a] = {};
        if (left_ >= 4) {
            const Piece quad = piece_at(a, 4);
            const double worst = skew(quad, 4);
            if (worst <= most_quad_skew && !holds_another(quad, 4)) cost_[a].quad = worst;
        }
        const Piece triangle = piece_at(a, 3);
        const double worst = skew(triangle, 3);
        // Any quad goes before any triangle.
        if (worst < not_allowed && !holds_another(triangle, 3)) cost_[a].triangle = std::numbers::pi + worst;
    }

    std::uint32_t best_of(std::uint32_t any) const {
        std::uint32_t best = any;
        for (std::uint32_t k = next_[any]; k != any; k = next_[k])
            if (cost_[k].least() < cost_[best].least()) best = k;
        return best;
    }

    // Cuts one piece off and returns a corner that is still there.
    std::uint32_t cut_best(std::uint32_t any, std::vector<Piece>& pieces) {
        std::uint32_t a = best_of(any);
        if (cost_[a].least() == not_allowed) {
            // What kept a piece from being cut may be gone.
            for (std::uint32_t k = next_[any];; k = next_[k]) {
                judge(k);
                if (k == any) break;
            }
            a = best_of(any);
        }
        const std::size_t count = cost_[a].quad <= cost_[a].triangle && cost_[a].quad < not_allowed ? 4 : 3;
        const Piece piece = piece_at(a, count);
        pieces.push_back(piece);
        const std::uint32_t last = piece[count - 1];
        if (left_ == count) {
            left_ = 0;
            return a;
        }
        next_[a] = last;
        before_[last] = a;
        left_ -= count - 2;
        // The pieces that begin here or up to three corners before have changed.
        std::uint32_t k = a;
        for (int back = 0; back < 4; ++back, k = before_[k]) judge(k);
        return a;
    }

    std::vector<Vec2> at_;
    std::size_t left_;
    std::vector<std::uint32_t> next_, before_;
    std::vector<Cost> cost_;
};

}  // namespace

bool is_convex(std::span<const Vec3> corners) {
    const std::vector<Vec2> at = flattened(corners);
    for (std::size_t k = 0; k < at.size(); ++k) {
        const Vec2 in = at[(k + 1) % at.size()] - at[k],
                   out = at[(k + 2) % at.size()] - at[(k + 1) % at.size()];
        if (cross(in, out) < -1e-3 * in.norm() * out.norm()) return false;
    }
    return true;
}

std::vector<Piece> cut_polygon(std::span<const Vec3> corners) {
    return PolygonCut(corners).cut();
}

}  // namespace unravel::sim
