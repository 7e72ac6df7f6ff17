#include "sim/terms/grid_rows.hpp"

#include <tbb/parallel_for.h>

namespace unravel::sim {

void load_rows(std::span<const Vec3> x, std::span<const Vec3> v, GridRows& cloth) {
    cloth.state.resize(cloth.rows() * 6 * cloth.stride);
    tbb::parallel_for(std::size_t{0}, cloth.rows(), [&](std::size_t row) {
        const std::size_t first = cloth.patch.first + row * cloth.columns();
        const Row to_x = cloth.x(row), to_v = cloth.v(row);
        for (std::size_t i = 0; i < cloth.columns(); ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                to_x[c][i] = x[first + i][static_cast<Eigen::Index>(c)];
                to_v[c][i] = v[first + i][static_cast<Eigen::Index>(c)];
            }
        }
        cloth.repeat_over_seam(row);
    });
}

}  // namespace unravel::sim
