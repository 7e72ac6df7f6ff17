#include "render/sky_light.hpp"

#include <cmath>
#include <numbers>

#include "render/color.hpp"

namespace unravel::render {

namespace {

constexpr float sky_pi = std::numbers::pi_v<float>;
constexpr int sky_rows = 64;  // the harmonics ask for no finer detail

/// The image's mean over each of rows × 2 rows parts, in linear light.
std::vector<Vec3f> coarse(const Image& image) {
    std::vector<Vec3f> parts(std::size_t{2} * sky_rows * sky_rows, Vec3f::Zero());
    std::vector<int> count(parts.size(), 0);
    const auto add = [&](int x, int y, int column, int row) {
        const std::uint8_t* p = image.at(x, y);
        const std::size_t part =
            static_cast<std::size_t>(row) * 2 * sky_rows + static_cast<std::size_t>(column);
        parts[part] += linear({p[0], p[1], p[2]});
        ++count[part];
    };
    // Every pixel goes to its part, and every part takes at least the pixel in its middle.
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            add(x, y, x * 2 * sky_rows / image.width, y * sky_rows / image.height);
    for (int row = 0; row < sky_rows; ++row)
        for (int column = 0; column < 2 * sky_rows; ++column) {
            const std::size_t part =
                static_cast<std::size_t>(row) * 2 * sky_rows + static_cast<std::size_t>(column);
            if (count[part] == 0)
                add((2 * column + 1) * image.width / (4 * sky_rows),
                    (2 * row + 1) * image.height / (2 * sky_rows), column, row);
            parts[part] /= static_cast<float>(count[part]);
        }
    return parts;
}

float brightness(const Vec3f& light) {
    return light.dot(Vec3f(0.2126f, 0.7152f, 0.0722f));
}

}  // namespace

std::array<Vec3f, 9> sky_harmonics(const Image& image, float mean, const std::optional<Vec3f>& below) {
    const std::vector<Vec3f> parts = coarse(image);
    const auto part = [&](int row, int column) -> const Vec3f& {
        return parts[static_cast<std::size_t>(row) * 2 * sky_rows + static_cast<std::size_t>(column)];
    };
    // Share of the whole sphere that a part of a row is.
    const auto area = [&](int row) {
        return std::sin(sky_pi * (static_cast<float>(row) + 0.5f) / sky_rows) * sky_pi /
               (4.f * sky_rows * sky_rows);
    };
    Vec3f upper = Vec3f::Zero();
    for (int row = 0; row < sky_rows / 2; ++row)
        for (int column = 0; column < 2 * sky_rows; ++column) upper += 2 * area(row) * part(row, column);
    const float scale = mean / std::max(brightness(upper), 1e-4f);

    std::array<Vec3f, 9> sum;
    sum.fill(Vec3f::Zero());
    for (int row = 0; row < sky_rows; ++row)
        for (int column = 0; column < 2 * sky_rows; ++column) {
            const float down = sky_pi * (static_cast<float>(row) + 0.5f) / sky_rows;
            const float turn = sky_pi * ((static_cast<float>(column) + 0.5f) / sky_rows - 1);
            const float x = std::sin(down) * std::sin(turn), y = std::cos(down),
                        z = -std::sin(down) * std::cos(turn);
            const Vec3f light = row >= sky_rows / 2 && below ? *below : Vec3f(scale * part(row, column));
            const float basis[] = {1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y};
            for (int k = 0; k < 9; ++k) sum[static_cast<std::size_t>(k)] += area(row) * basis[k] * light;
        }
    // Squares of the basis' norms, times what a matt surface makes of each band: 1, 2/3, 1/4.
    constexpr float weight[] = {1, 2, 2, 2, 15.f / 4, 15.f / 4, 5.f / 16, 15.f / 4, 15.f / 16};
    for (std::size_t k = 0; k < 9; ++k) sum[k] *= weight[k];
    return sum;
}

Vec3f light_of(const std::array<Vec3f, 9>& c, const Vec3f& n) {
    const float x = n.x(), y = n.y(), z = n.z();
    return c[0] + c[1] * y + c[2] * z + c[3] * x + c[4] * (x * y) + c[5] * (y * z) + c[6] * (3 * z * z - 1) +
           c[7] * (x * z) + c[8] * (x * x - y * y);
}

}  // namespace unravel::render
