#pragma once

// Surfaces for tests: soups of loose triangles, and sheets.

#include <random>

#include "sim/surface/surface.hpp"

namespace unravel::testing {

using namespace sim;

/// A surface and where its particles are.
struct PlacedSurface {
    Surface surface;
    std::vector<Vec3> x;
};

inline Vec3 random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size, size);
    const double a = uniform(random), b = uniform(random), c = uniform(random);
    return {a, b, c};
}

/// Triangles of about `size` metres in a cube of two metres, each with corners of its own.
inline PlacedSurface soup(std::uint32_t triangles, double size, unsigned seed) {
    std::mt19937 random(seed);
    PlacedSurface out;
    SurfaceBuilder builder;
    builder.add_mesh(0, 3 * triangles);
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const Vec3 middle = random_vector(random, 1);
        for (int k = 0; k < 3; ++k) out.x.push_back(middle + random_vector(random, size));
        builder.add_face(std::array<std::uint32_t, 3>{3 * t, 3 * t + 1, 3 * t + 2});
    }
    out.surface = builder.build();
    return out;
}

/// Sheets of n × n particles and a metre, one above the other, crumpled by `jitter` metres.
inline PlacedSurface crumpled_sheets(int sheets, int n, double apart, double jitter, unsigned seed) {
    std::mt19937 random(seed);
    PlacedSurface out;
    SurfaceBuilder builder;
    for (int s = 0; s < sheets; ++s) {
        builder.add_grid(static_cast<std::uint32_t>(out.x.size()), n, n, false);
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i)
                out.x.push_back(Vec3(1.0 * i / (n - 1), s * apart, 1.0 * j / (n - 1)) +
                                random_vector(random, jitter));
        }
    }
    out.surface = builder.build();
    return out;
}

}  // namespace unravel::testing
