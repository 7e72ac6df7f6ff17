#include "tool/inspect/pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/plot/canvas.hpp"
#include "tool/plot/ticks.hpp"

namespace unravel::tool {

namespace {

constexpr int side = 480, pattern_left = 62, pattern_top = 40, page_width = side + pattern_left + 18,
              page_height = side + pattern_top + 44;
// Beyond so many rows a block is less than half a pixel, and dots would only pile up.
constexpr std::uint32_t most_rows_as_dots = 1200;
constexpr Rgb block_ink{20, 60, 130}, outline{205, 30, 30}, pattern_grey{90, 96, 106};

void couple(Pattern& pattern, std::uint32_t i, std::uint32_t j) {
    pattern.entries.push_back({i, j});
    pattern.entries.push_back({j, i});
}

// Two springs between the same particles make one block.
void settle(Pattern& pattern) {
    for (std::uint32_t row = 0; row < pattern.rows; ++row) pattern.entries.push_back({row, row});
    std::sort(pattern.entries.begin(), pattern.entries.end());
    pattern.entries.erase(std::unique(pattern.entries.begin(), pattern.entries.end()), pattern.entries.end());
}

// Blocks per pixel, darker where there are more, on a scale that shows a single one.
Image density(const Pattern& pattern) {
    constexpr int pixels = 2 * side;
    std::vector<std::uint32_t> count(static_cast<std::size_t>(pixels) * pixels);
    const auto pixel = [&](std::uint32_t index) {
        return static_cast<std::size_t>(std::uint64_t{index} * pixels / pattern.rows);
    };
    for (const auto& [row, column] : pattern.entries) ++count[pixel(row) * pixels + pixel(column)];
    const double most = std::log1p(*std::max_element(count.begin(), count.end()));
    Image image;
    image.width = image.height = pixels;
    image.pixels.resize(count.size() * 4);
    for (std::size_t k = 0; k < count.size(); ++k) {
        const double share = count[k] == 0 ? 0 : 0.35 + 0.65 * std::log1p(count[k]) / most;
        const auto mix = [&](std::uint8_t c) {
            return static_cast<std::uint8_t>(std::lround(255 + share * (c - 255)));
        };
        const std::uint8_t value[4] = {mix(block_ink.r), mix(block_ink.g), mix(block_ink.b), 255};
        std::copy_n(value, 4, image.pixels.begin() + static_cast<std::ptrdiff_t>(4 * k));
    }
    return image;
}

void draw(const Pattern& pattern, Canvas& canvas) {
    const double unit = static_cast<double>(side) / std::max<std::uint32_t>(pattern.rows, 1);
    canvas.color(block_ink);
    if (pattern.rows > most_rows_as_dots) {
        canvas.picture(density(pattern), pattern_left, pattern_top, side, side);
    } else {
        const double dot = std::max(unit, 0.9);
        for (const auto& [row, column] : pattern.entries)
            canvas.add_rectangle(pattern_left + column * unit, pattern_top + row * unit, dot, dot);
        canvas.fill();
    }
    canvas.color(outline);
    canvas.width(1.4);
    for (const auto& [begin, end] : pattern.blocks) {
        // A component too small to be seen would only leave a red stroke.
        if ((end - begin) * unit < 3) continue;
        canvas.frame(pattern_left + begin * unit, pattern_top + begin * unit, (end - begin) * unit,
                     (end - begin) * unit);
    }
    canvas.color(pattern_grey);
    canvas.width(1);
    canvas.frame(pattern_left, pattern_top, side, side);
    canvas.font(12);
    if (pattern.rows > 1) {
        for (const Tick& tick : linear_ticks(0, pattern.rows, 6)) {
            canvas.text(pattern_left + tick.value * unit, pattern_top + side + 16, tick.label, Align::middle);
            canvas.text(pattern_left - 7, pattern_top + tick.value * unit + 4, tick.label, Align::end);
        }
    }
    canvas.text(
        pattern_left + side / 2.0, pattern_top + side + 36,
        fmt::format("nz = {}   ({:.2f} blocks per row)", pattern.entries.size(),
                    static_cast<double>(pattern.entries.size()) / std::max<std::uint32_t>(pattern.rows, 1)),
        Align::middle);
    canvas.color({30, 34, 40});
    canvas.font(14, true);
    canvas.text(pattern_left, 24, pattern.title);
}

}  // namespace

Pattern implicit_pattern(const ClothModel& model) {
    Pattern pattern{"Implicit scheme: every spring", static_cast<std::uint32_t>(model.size()), {}, {}};
    for (std::size_t s = 0; s < model.springs.size(); ++s)
        couple(pattern, model.springs.i[s], model.springs.j[s]);
    for (std::size_t s = 0; s < model.bends.size(); ++s) couple(pattern, model.bends.i[s], model.bends.j[s]);
    for (std::size_t s = 0; s < model.curvature.size(); ++s) {
        const std::uint32_t count = model.curvature.count(s);
        for (std::uint32_t a = 0; a < count; ++a) {
            for (std::uint32_t b = a + 1; b < count; ++b)
                couple(pattern, model.curvature.p[s][a], model.curvature.p[s][b]);
        }
    }
    settle(pattern);
    return pattern;
}

Pattern step_pattern(const ClothModel& model, const std::vector<SpringState>& springs,
                     const std::vector<std::array<std::uint32_t, 2>>& extra) {
    Pattern pattern{"This step, as assembled", static_cast<std::uint32_t>(model.size()), {}, {}};
    for (std::size_t s = 0; s < springs.size(); ++s) {
        if (springs[s] == SpringState::implicit) couple(pattern, model.springs.i[s], model.springs.j[s]);
    }
    for (const auto& [i, j] : extra) couple(pattern, i, j);
    settle(pattern);
    return pattern;
}

Pattern reordered_pattern(const Pattern& pattern, const Components& components) {
    Pattern out{"Reordered by component", pattern.rows, {}, {}};
    std::vector<std::uint32_t> row_of(pattern.rows);
    for (std::uint32_t row = 0; row < pattern.rows; ++row) row_of[components.order[row]] = row;
    for (const auto& [i, j] : pattern.entries) {
        const bool held = components.label[i] < 0 || components.label[j] < 0;
        if (i == j || !held) out.entries.push_back({row_of[i], row_of[j]});
    }
    std::sort(out.entries.begin(), out.entries.end());
    for (std::size_t c = 0; c < components.count(); ++c)
        out.blocks.push_back({components.start[c], components.start[c + 1]});
    return out;
}

std::string pattern_svg(const Pattern& pattern) {
    return canvas_svg(page_width, page_height, [&](Canvas& canvas) { draw(pattern, canvas); });
}

Image pattern_image(const Pattern& pattern, double scale) {
    return canvas_image(page_width, page_height, scale, [&](Canvas& canvas) { draw(pattern, canvas); });
}

}  // namespace unravel::tool
