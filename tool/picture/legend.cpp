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
constexpr Rgb panel{16, 18, 22}, legend_ink{232, 234, 238}, quiet_ink{168, 172, 182};

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

Content component_content(const FrameRecord& record) {
    std::vector<int> sizes;
    for (const std::int32_t id : record.component) {
        if (id < 0) continue;
        if (static_cast<std::size_t>(id) >= sizes.size()) sizes.resize(static_cast<std::size_t>(id) + 1, 0);
        ++sizes[static_cast<std::size_t>(id)];
    }
    Content content{.title = "components"};
    content.numbers = sizes.size() == 1 ? "1 component" : fmt::format("{} components", sizes.size());
    if (!sizes.empty()) content.numbers += fmt::format(", largest {}", std::ranges::max(sizes));
    content.rows = {{{component_palette.begin(), component_palette.begin() + 5}, "solved apart"},
                    {{constrained_color},
                     fmt::format("fully constrained: {}", count(record.component, std::int32_t{-1}))},
                    {{single_color}, "alone"}};
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

Content content_of(const Look& look, const FrameRecord& record) {
    switch (look.show) {
        case Show::components:
            return component_content(record);
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

void draw(Canvas& canvas, double size, double height, const Content& content) {
    canvas.color(panel, 0.72);
    canvas.rectangle(0, 0, panel_width * size, height);
    const double left = padding * size;
    double y = padding * size + size;
    canvas.font(size, true);
    canvas.color(legend_ink);
    canvas.text(left, y, content.title);
    y += line_height * size;
    canvas.font(size);
    canvas.color(quiet_ink);
    canvas.text(left, y, content.numbers);
    y += line_height * size;
    for (const Row& row : content.rows) {
        double x = left;
        for (const Rgb color : row.colors) {
            canvas.color(color);
            canvas.rectangle(x, y - swatch * size, swatch * size, swatch * size);
            x += 1.1 * swatch * size;
        }
        canvas.color(legend_ink);
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
    canvas.color(legend_ink);
    canvas.text(left, y, content.low);
    canvas.text(left + width, y, content.high, Align::end);
}

double lines_of(const Content& content) {
    return 2 + static_cast<double>(content.rows.size()) + (content.high.empty() ? 0 : 2);
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
    page_->size = std::max(7.0, height / 42.0);
}

Legend::~Legend() = default;

void Legend::add(const FrameRecord& record, Image& picture) {
    Content content = content_of(page_->scene->look, record);
    const std::string time = fmt::format("{:.2f} s", frame_time(*page_->scene, record.frame));
    content.numbers = content.numbers.empty() ? time : time + ", " + content.numbers;
    const double size = page_->size, tall = (2 * padding - 0.3 + line_height * lines_of(content)) * size;
    const int width = std::min(static_cast<int>(panel_width * size), picture.width);
    const int height = std::min(static_cast<int>(tall), picture.height);
    if (!page_->surface) {
        page_->surface.reset(cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height));
        page_->context.reset(cairo_create(page_->surface.get()));
        if (cairo_status(page_->context.get()) != CAIRO_STATUS_SUCCESS)
            throw std::runtime_error("cairo has no memory for a legend");
    }
    cairo_t* const context = page_->context.get();
    cairo_set_operator(context, CAIRO_OPERATOR_CLEAR);
    cairo_paint(context);
    cairo_set_operator(context, CAIRO_OPERATOR_OVER);
    Canvas canvas(context);
    draw(canvas, size, tall, content);
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
