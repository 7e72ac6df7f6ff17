#include "tool/picture/legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "render/palette.hpp"
#include "tool/picture/view.hpp"
#include "tool/picture/wire_colors.hpp"
#include "tool/plot/canvas.hpp"

namespace unravel::tool {

namespace {

// In units of the text's size.
constexpr double line_height = 1.5, padding = 0.8, swatch = 0.85, panel_width = 23, bar_height = 0.8;
constexpr int most_lines = 10;  // of any content

struct Inks {
    Rgb panel, text, quiet;
    double cover;  // of what is behind the panel
};
constexpr Inks inks_on_screen{{16, 18, 22}, {232, 234, 238}, {168, 172, 182}, 0.72},
    inks_on_page{{255, 255, 255}, {24, 26, 30}, {90, 94, 102}, 0};

struct Row {
    std::vector<Rgb> colors;  // one, or some of many
    std::string text;
};

struct Content {
    std::string title{}, numbers{};
    std::vector<Row> rows{};
    std::string low{}, high{};  // of a scale of colours; empty: there is none
};

template <class Values, class Value>
std::ptrdiff_t count(const Values& values, Value value) {
    return std::count(values.begin(), values.end(), value);
}

std::string grouped(std::ptrdiff_t number) {
    std::string digits = std::to_string(number);
    for (std::ptrdiff_t k = static_cast<std::ptrdiff_t>(digits.size()) - 3; k > 0; k -= 3)
        digits.insert(static_cast<std::size_t>(k), ",");
    return digits;
}

Content component_content(const FrameRecord& record, std::span<const Rgb> colors) {
    constexpr std::size_t told = 5;
    struct Component {
        std::ptrdiff_t size = 0, left = 0;
        Rgb color;  // what most of its particles wear [Boyer & Moore 1981]: while it changes, some lag behind
    };
    std::vector<Component> all;
    for (std::size_t p = 0; p < record.component.size(); ++p) {
        if (record.component[p] < 0) continue;
        const auto id = static_cast<std::size_t>(record.component[p]);
        if (id >= all.size()) all.resize(id + 1);
        Component& component = all[id];
        ++component.size;
        if (component.left == 0) component.color = colors[p];
        component.left += component.color == colors[p] ? 1 : -1;
    }
    Content content{.title = "components"};
    content.numbers = all.size() == 1 ? "1 component" : grouped(std::ssize(all)) + " components";
    std::ranges::stable_sort(all, std::greater{}, &Component::size);
    const std::ptrdiff_t alone = std::ranges::count(all, 1, &Component::size);
    std::ptrdiff_t others = 0, particles = 0;
    for (std::size_t k = 0; k < all.size() && all[k].size > 1; ++k) {
        if (k < told) {
            content.rows.push_back({{all[k].color}, grouped(all[k].size) + " particles"});
            continue;
        }
        ++others;
        particles += all[k].size;
    }
    if (others > 0)
        content.rows.push_back(
            {{}, fmt::format("{} more of {} particles", grouped(others), grouped(particles))});
    if (alone > 0) content.rows.push_back({{single_color}, "alone: " + grouped(alone)});
    content.rows.push_back(
        {{constrained_color}, "fully constrained: " + grouped(count(record.component, std::int32_t{-1}))});
    return content;
}

Content splitting_content(const FrameRecord& record) {
    const auto row = [&](Rgb color, const char* name, SpringState state) {
        return Row{{color}, fmt::format("{}: {}", name, count(record.springs, state))};
    };
    return {.title = "springs by splitting",
            .rows = {row(implicit_color, "implicit", SpringState::implicit),
                     row(explicit_color, "explicit", SpringState::explicit_),
                     row(inactive_color, "slack", SpringState::inactive)}};
}

Content contact_content(const FrameRecord& record) {
    const auto none = count(record.free, 0), all = count(record.free, 3);
    const auto some = static_cast<std::ptrdiff_t>(record.free.size()) - none - all;
    return {.title = "free directions",
            .rows = {{{free_color}, fmt::format("three: {}", all)},
                     {{partly_color}, fmt::format("one or two: {}", some)},
                     {{constrained_color}, fmt::format("none: {}", none)}}};
}

Content content_of(const Look& look, const FrameRecord& record, std::span<const Rgb> colors) {
    switch (look.show) {
        case Show::components:
            return component_content(record, colors);
        case Show::splitting:
            return splitting_content(record);
        case Show::strain:
            return {.title = "strain of stretch springs",
                    .rows = {{{inactive_color}, "slack"}},
                    .low = "0",
                    .high = fmt::format("{:g}%", 100 * scale_end(look))};
        case Show::velocity:
            return {.title = "speed", .low = "0", .high = fmt::format("{:g} m/s", scale_end(look))};
        case Show::contact:
            return contact_content(record);
    }
    return {};
}

void draw_content(Canvas& canvas, double size, double height, const Inks& inks, const Content& content) {
    canvas.color(inks.panel, inks.cover);
    canvas.rectangle(0, 0, panel_width * size, height);
    const double left = padding * size;
    double y = padding * size + size;
    canvas.font(size, true);
    canvas.color(inks.text);
    canvas.text(left, y, content.title);
    y += line_height * size;
    canvas.font(size);
    canvas.color(inks.quiet);
    canvas.text(left, y, content.numbers);
    y += line_height * size;
    for (const Row& row : content.rows) {
        double x = left;
        for (const Rgb color : row.colors) {
            canvas.color(color);
            canvas.rectangle(x, y - swatch * size, swatch * size, swatch * size);
            if (color == inks.panel) {  // white on white
                canvas.color(inks.quiet);
                canvas.width(0.06 * size);
                canvas.frame(x, y - swatch * size, swatch * size, swatch * size);
            }
            x += 1.1 * swatch * size;
        }
        canvas.color(inks.text);
        canvas.text(x + 0.4 * size, y, row.text);
        y += line_height * size;
    }
    if (content.high.empty()) return;
    constexpr int steps = 64;
    const double width = (panel_width - 2 * padding) * size;
    for (int k = 0; k < steps; ++k) {
        canvas.color(scale_color((k + 0.5) / steps));
        canvas.rectangle(left + width * k / steps, y - bar_height * size, width / steps + 0.5,
                         bar_height * size);
    }
    y += line_height * size;
    canvas.color(inks.text);
    canvas.text(left, y, content.low);
    canvas.text(left + width, y, content.high, Align::end);
}

double lines_of(const Content& content) {
    return 2 + static_cast<double>(content.rows.size()) + (content.high.empty() ? 0 : 2);
}

Content timed_content(const Scene& scene, const FrameRecord& record, std::span<const Rgb> colors) {
    Content content = content_of(scene.look, record, colors);
    const std::string time = fmt::format("{:.2f} s", frame_time(scene, record.frame));
    content.numbers = content.numbers.empty() ? time : time + ", " + content.numbers;
    return content;
}

double text_size(int height) {
    return std::max(7.0, height / 42.0);
}

double height_of(const Content& content, double size) {
    return (2 * padding - 0.3 + line_height * lines_of(content)) * size;
}

// `value` of 255 parts of x.
int part(int x, int value) {
    return (x * value + 127) / 255;
}

}  // namespace

struct Legend::Page {
    struct Delete {
        void operator()(cairo_surface_t* p) const { cairo_surface_destroy(p); }
        void operator()(cairo_t* p) const { cairo_destroy(p); }
    };
    const Scene* scene;
    double size;  // of the text [px]
    std::unique_ptr<cairo_surface_t, Delete> surface;
    std::unique_ptr<cairo_t, Delete> context;
};

Legend::Legend(const Scene& scene, int height) : page_(std::make_unique<Page>()) {
    page_->scene = &scene;
    page_->size = text_size(height);
}

Legend::~Legend() = default;

void Legend::draw(const Scene& scene, const FrameRecord& record, std::span<const Rgb> colors, int height,
                  Canvas& canvas) {
    const Content content = timed_content(scene, record, colors);
    const double size = text_size(height), tall = height_of(content, size);
    canvas.move_origin(padding * size, height - tall - padding * size);
    draw_content(canvas, size, tall, inks_on_page, content);
    canvas.move_origin(-padding * size, tall + padding * size - height);
}

void Legend::add(const FrameRecord& record, std::span<const Rgb> colors, Image& picture) {
    const Content content = timed_content(*page_->scene, record, colors);
    const double size = page_->size, tall = height_of(content, size);
    const int width = std::min(static_cast<int>(panel_width * size), picture.width);
    const int height = std::min(static_cast<int>(tall), picture.height);
    if (!page_->surface) {
        const double most = (2 * padding + line_height * most_lines) * size;
        page_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, static_cast<int>(most)));
        page_->context.reset(cairo_create(page_->surface.get()));
        if (cairo_status(page_->context.get()) != CAIRO_STATUS_SUCCESS)
            throw std::runtime_error("cairo has no memory for a legend");
    }
    cairo_t* const context = page_->context.get();
    cairo_set_operator(context, CAIRO_OPERATOR_CLEAR);
    cairo_paint(context);
    cairo_set_operator(context, CAIRO_OPERATOR_OVER);
    Canvas canvas(context);
    draw_content(canvas, size, tall, inks_on_screen, content);
    cairo_surface_flush(page_->surface.get());

    const unsigned char* const rows = cairo_image_surface_get_data(page_->surface.get());
    const int stride = cairo_image_surface_get_stride(page_->surface.get());
    const int margin = static_cast<int>(padding * size);
    const int left = std::min(margin, picture.width - width),
              top = std::max(0, picture.height - height - margin);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::uint32_t above = 0;  // premultiplied
            std::memcpy(&above, rows + static_cast<std::ptrdiff_t>(y) * stride + 4 * x, sizeof above);
            std::uint8_t* const p = picture.at(left + x, top + y);
            const int rest = 255 - static_cast<int>(above >> 24), below = part(p[3], rest);
            const int alpha = static_cast<int>(above >> 24) + below;
            for (int c = 0; c < 3; ++c) {
                const int color = static_cast<int>(above >> (16 - 8 * c) & 255) + part(p[c], below);
                p[c] = static_cast<std::uint8_t>(alpha > 0 ? std::min(255, (255 * color + alpha / 2) / alpha)
                                                           : 0);
            }
            p[3] = static_cast<std::uint8_t>(alpha);
        }
}

}  // namespace unravel::tool
