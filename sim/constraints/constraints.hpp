#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/scene/math.hpp"

namespace unravel::sim {

/// One particle's constraint (Baraff & Witkin 1998, Sec. 5; paper Eq. 9): S its orthogonal projection on the
/// free directions, z the prescribed part of its Δv.
struct Constraint {
    std::uint32_t particle = 0;
    std::uint8_t free = 0;  ///< directions left: 0 (fully constrained), 1 or 2
    Mat3 S = Mat3::Zero();
    Vec3 z{0, 0, 0};  ///< m/s
};

/// The step's constraints. Costs memory for a particle only where one acts, but for one index per particle.
class Constraints {
public:
    /// Forgets all constraints, for n particles.
    void reset(std::size_t n) {
        if (index_.size() != n) {
            index_.assign(n, -1);
        } else {
            for (const Constraint& c : list_) index_[c.particle] = -1;
        }
        list_.clear();
    }
    /// Particles must not be constrained already.
    void add(const Constraint& c) {
        index_[c.particle] = static_cast<std::int32_t>(list_.size());
        list_.push_back(c);
    }
    /// What was prescribed has been done: of the constraints only S remains.
    void clear_prescribed() {
        for (Constraint& c : list_) c.z.setZero();
    }
    const Constraint* find(std::uint32_t particle) const {
        const std::int32_t k = index_[particle];
        return k < 0 ? nullptr : &list_[static_cast<std::size_t>(k)];
    }
    bool fully(std::uint32_t particle) const {
        const Constraint* c = find(particle);
        return c && c->free == 0;
    }
    std::span<const Constraint> all() const { return list_; }

private:
    std::vector<std::int32_t> index_;  // (particles) into list_, −1: free
    std::vector<Constraint> list_;
};

}  // namespace unravel::sim
