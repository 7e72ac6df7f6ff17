#include "sim/model/mesh_curvature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/model/mesh_fans.hpp"
#include "sim/model/mesh_springs.hpp"

namespace unravel::sim {

namespace {

// Runs that meet the edge opposite so near to a vertex meet the vertex.
constexpr double on_vertex = 1e-6;

// The component of curvature that a stencil sees, (T_xx, T_yy, √2 T_xy) [m²]: the product of two is T : T'.
using Component = Vec3;

struct Candidate {
    std::size_t stencil;
    Component seen;
};

// Weights of four places in a plane with Σ w = 0 and Σ w X = 0, of Σ|w| = 4.
std::array<double, 4> flat_weights(const std::array<Vec2, 4>& at) {
    const auto twice_area = [&](std::size_t a, std::size_t b, std::size_t c) {
        const Vec2 d = at[b] - at[a], e = at[c] - at[a];
        return d.x() * e.y() - d.y() * e.x();
    };
    std::array<double, 4> w{twice_area(1, 2, 3), -twice_area(0, 2, 3), twice_area(0, 1, 3),
                            -twice_area(0, 1, 2)};
    double sum = 0;
    for (const double weight : w) sum += std::abs(weight);
    for (double& weight : w) weight *= sum > 0 ? 4 / sum : 0.0;
    return w;
}

// Two triangles on the edge from a to b, p on its left and q on its right, laid flat: a, p, b, q.
std::array<Vec2, 4> laid_flat(const MeshCloth& mesh, const std::array<std::uint32_t, 4>& of) {
    const Vec3 &a = mesh.rest[of[0]], edge = mesh.rest[of[2]] - a, along = edge.normalized();
    const auto wing = [&](std::uint32_t v, double side) {
        const Vec3 d = mesh.rest[v] - a;
        return Vec2(along.dot(d), side * along.cross(d).norm());
    };
    return {Vec2(0, 0), wing(of[1], 1), Vec2(edge.norm(), 0), wing(of[3], -1)};
}

std::uint32_t opposite(const MeshCloth::Cell& triangle, const MeshCloth::Edge& edge) {
    std::uint32_t found = no_index;
    for (std::size_t k = 0; k < 3; ++k) {
        if (triangle.vertex[k] != edge.a && triangle.vertex[k] != edge.b) found = triangle.vertex[k];
    }
    return found;
}

class CurvatureFit {
public:
    explicit CurvatureFit(const MeshCloth& mesh) : mesh_(mesh) {
        const auto add = [&](const std::array<std::uint32_t, 4>& of) {
            all_.push_back({4, of, flat_weights(laid_flat(mesh, of)), 0.0});
            return all_.size() - 1;
        };
        for (const MeshCloth::Cell& cell : mesh.cells)
            of_cell_.push_back(cell.corners == 4 ? add(cell.vertex) : none);
        for (const MeshCloth::Edge& edge : mesh.edges) {
            of_edge_.push_back(none);
            if (edge.cell[1] == no_index) continue;
            const MeshCloth::Cell &one = mesh.cells[edge.cell[0]], &other = mesh.cells[edge.cell[1]];
            if (one.corners == 3 && other.corners == 3)
                of_edge_.back() = add({edge.a, opposite(one, edge), edge.b, opposite(other, edge)});
        }
    }

    void fit(std::uint32_t v, const Fan& fan) {
        place(fan);
        candidates_.clear();
        for (std::size_t k = 0; k < fan.spokes.size(); ++k) {
            if (!fan.spokes[k].diagonal) add_run(v, fan, k);
        }
        double area = 0;
        for (const std::uint32_t c : fan.cells) {
            area += mesh_.area(mesh_.cells[c]) / mesh_.cells[c].corners;
            add_candidate(of_cell_[c], v, fan);
        }
        for (const Fan::Spoke& spoke : fan.spokes) {
            if (!spoke.diagonal) add_candidate(hinge_at(v, spoke.end), v, fan);
        }
        share_out(area);
    }

    std::vector<MeshCurvature> take() {
        std::erase_if(all_, [](const MeshCurvature& stencil) { return stencil.stiffness <= 0; });
        return std::move(all_);
    }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    // Where a fan's spokes end, laid flat. Cloth that is no plane around the vertex is spread over the whole
    // turn.
    void place(const Fan& fan) {
        const double scale = fan.closed ? 2 * std::numbers::pi / fan.whole : 1.0;
        ends_.clear();
        for (const Fan::Spoke& spoke : fan.spokes) {
            const double angle = scale * spoke.angle;
            ends_.push_back(spoke.length * Vec2(std::cos(angle), std::sin(angle)));
        }
    }

    std::size_t hinge_at(std::uint32_t v, std::uint32_t end) const {
        const auto ends = std::pair(std::min(v, end), std::max(v, end));
        const auto edge = std::lower_bound(
            mesh_.edges.begin(), mesh_.edges.end(), ends,
            [](const MeshCloth::Edge& e, const auto& key) { return std::pair(e.a, e.b) < key; });
        return of_edge_[static_cast<std::size_t>(edge - mesh_.edges.begin())];
    }

    void see(std::size_t stencil, std::span<const Vec2> at, std::span<const double> weights) {
        Eigen::Matrix2d T = Eigen::Matrix2d::Zero();
        for (std::size_t k = 0; k < at.size(); ++k) T += 0.5 * weights[k] * at[k] * at[k].transpose();
        candidates_.push_back({stencil, {T(0, 0), T(1, 1), std::numbers::sqrt2 * T(0, 1)}});
    }

    // A stencil whose particles are all of the fan.
    void add_candidate(std::size_t stencil, std::uint32_t v, const Fan& fan) {
        if (stencil == none) return;
        const MeshCurvature& s = all_[stencil];
        std::array<Vec2, 4> at;
        for (std::size_t k = 0; k < 4; ++k) {
            at[k] = Vec2::Zero();
            for (std::size_t end = 0; end < ends_.size(); ++end) {
                if (s.vertex[k] != v && fan.spokes[end].end == s.vertex[k]) at[k] = ends_[end];
            }
        }
        see(stencil, at, s.weight);
    }

    // The run from spoke k through the vertex, to where its line meets what is opposite.
    void add_run(std::uint32_t v, const Fan& fan, std::size_t k) {
        const Vec2 on = -ends_[k].normalized();
        const std::size_t n = ends_.size();
        // How far an end lies off the line, as a share of its distance; beyond any where it is behind.
        const auto off = [&](std::size_t j) {
            const Vec2& end = ends_[j];
            return on.dot(end) > 0 ? (on.x() * end.y() - on.y() * end.x()) / end.norm() : 2.0;
        };
        for (std::size_t j = 0; j < n; ++j) {
            if (std::abs(off(j)) > on_vertex) continue;
            // The same run from its other end is no other.
            if (fan.spokes[j].diagonal || j > k)
                push_run({fan.spokes[k].end, v, fan.spokes[j].end}, k, j, j, 0);
            return;
        }
        for (std::size_t j = 0; j + (fan.closed ? 0 : 1) < n; ++j) {
            const std::size_t next = (j + 1) % n;
            if (j == k || next == k) continue;
            // The line passes between two ends from the one on its right to the one on its left.
            const auto side = [&](const Vec2& end) { return on.x() * end.y() - on.y() * end.x(); };
            const double before = side(ends_[j]), behind = side(ends_[next]);
            if (!(before < 0 && behind > 0)) continue;
            const double share = before / (before - behind);
            if (on.dot(ends_[j] + share * (ends_[next] - ends_[j])) <= 0) continue;
            push_run({fan.spokes[k].end, v, fan.spokes[j].end, fan.spokes[next].end}, k, j, next, share);
            return;
        }
    }

    // A run from spoke k to the point that divides the way from spoke j to spoke `next`.
    void push_run(std::array<std::uint32_t, 4> of, std::size_t k, std::size_t j, std::size_t next,
                  double share) {
        const double a = ends_[k].norm(), b = (ends_[j] + share * (ends_[next] - ends_[j])).norm();
        const double last = 2 * a / (a + b);
        const std::array<double, 4> weight{2 * b / (a + b), -2, (1 - share) * last, share * last};
        const std::uint32_t count = j == next ? 3 : 4;
        all_.push_back({count, of, weight, 0.0});
        const std::array<Vec2, 4> at{ends_[k], Vec2::Zero(), ends_[j], ends_[next]};
        see(all_.size() - 1, std::span(at).first(count), std::span(weight).first(count));
    }

    // Least squares of Σ s v̂ v̂ᵀ = I over s ≥ 0, v̂ the components' directions, by multiplicative steps: they
    // keep the sign, and treat alike what is alike. c = s · area/|T|².
    void share_out(double area) {
        constexpr int steps = 500;
        std::erase_if(candidates_, [](const Candidate& c) { return c.seen.norm() == 0; });
        const auto n = static_cast<Eigen::Index>(candidates_.size());
        if (n == 0) return;
        Eigen::MatrixXd both(n, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = 0; j < n; ++j) {
                const double cosine = candidates_[static_cast<std::size_t>(i)].seen.normalized().dot(
                    candidates_[static_cast<std::size_t>(j)].seen.normalized());
                both(i, j) = cosine * cosine;
            }
        }
        Eigen::VectorXd s = Eigen::VectorXd::Ones(n);
        for (int k = 0; k < steps; ++k) {
            const Eigen::VectorXd next = s.cwiseQuotient(both * s);
            const bool still = (next - s).cwiseAbs().maxCoeff() < 1e-12;
            s = next;
            if (still) break;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            const Candidate& c = candidates_[static_cast<std::size_t>(i)];
            all_[c.stencil].stiffness += s[i] * area / c.seen.squaredNorm();
        }
    }

    const MeshCloth& mesh_;
    std::vector<MeshCurvature> all_;
    std::vector<std::size_t> of_cell_, of_edge_;
    std::vector<Vec2> ends_;
    std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<MeshCurvature> curvature_of(const MeshCloth& mesh) {
    CurvatureFit fit(mesh);
    FanWalk(mesh).each([&](std::uint32_t v, const Fan& fan) { fit.fit(v, fan); });
    return fit.take();
}

}  // namespace unravel::sim
