#include "tool/plot/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace unravel::tool {

namespace {

struct SurfaceDeleter {
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
};
struct ContextDeleter {
    void operator()(cairo_t* c) const { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Context = std::unique_ptr<cairo_t, ContextDeleter>;

void require(cairo_status_t status) {
    if (status != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error(std::string("can't draw a plot: ") + cairo_status_to_string(status));
}

cairo_status_t append(void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

void draw_on(cairo_surface_t* surface, double scale, const std::function<void(Canvas&)>& draw) {
    require(cairo_surface_status(surface));
    const Context context(cairo_create(surface));
    cairo_scale(context.get(), scale, scale);
    cairo_set_source_rgb(context.get(), 1, 1, 1);
    cairo_paint(context.get());
    cairo_set_line_join(context.get(), CAIRO_LINE_JOIN_ROUND);
    Canvas canvas(context.get());
    draw(canvas);
    require(cairo_status(context.get()));
}

// Cairo names glyphs and clips by numbers that go on from document to document: the same picture has others
// each time, and in a page that holds two of them the second may be written with the letters of the first. So
// names are numbered as they come, behind a hash of the document.
std::string with_own_names(const std::string& svg) {
    constexpr std::string_view before_names[] = {"id=\"", "href=\"#", "url(#"};
    std::map<std::string, std::size_t> known;
    std::vector<std::pair<std::size_t, std::size_t>> found;  // where a name was, and its number
    std::string nameless;
    for (std::size_t k = 0; k < svg.size();) {
        const auto* const begins =
            std::find_if(std::begin(before_names), std::end(before_names),
                         [&](std::string_view text) { return svg.compare(k, text.size(), text) == 0; });
        if (begins == std::end(before_names)) {
            nameless += svg[k++];
            continue;
        }
        nameless += *begins;
        k += begins->size();
        const std::size_t end = svg.find_first_of("\")", k);
        found.emplace_back(nameless.size(),
                           known.try_emplace(svg.substr(k, end - k), known.size()).first->second);
        k = end;
    }
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const char c : nameless) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
    std::string named;
    std::size_t from = 0;
    for (const auto& [at, number] : found) {
        named.append(nameless, from, at - from);
        named += fmt::format("p{:016x}-{}", hash, number);
        from = at;
    }
    return named.append(nameless, from);
}

}  // namespace

void Canvas::color(Rgb c, double opacity) {
    cairo_set_source_rgba(cr_, c.r / 255.0, c.g / 255.0, c.b / 255.0, opacity);
}

void Canvas::dash(bool on) {
    const double lengths[] = {5, 4};
    cairo_set_dash(cr_, lengths, on ? 2 : 0, 0);
}

void Canvas::line(double x0, double y0, double x1, double y1) {
    cairo_move_to(cr_, x0, y0);
    cairo_line_to(cr_, x1, y1);
    cairo_stroke(cr_);
}

void Canvas::rectangle(double x, double y, double w, double h) {
    cairo_rectangle(cr_, x, y, w, h);
    cairo_fill(cr_);
}

void Canvas::frame(double x, double y, double w, double h) {
    cairo_rectangle(cr_, x, y, w, h);
    cairo_stroke(cr_);
}

void Canvas::disc(double x, double y, double radius) {
    cairo_arc(cr_, x, y, radius, 0, 2 * std::numbers::pi);
    cairo_fill(cr_);
}

void Canvas::clip(double x, double y, double w, double h) {
    cairo_save(cr_);
    cairo_rectangle(cr_, x, y, w, h);
    cairo_clip(cr_);
}

void Canvas::font(double size, bool bold) {
    cairo_select_font_face(cr_, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr_, size);
}

double Canvas::text_width(const std::string& text) const {
    cairo_text_extents_t extents;
    cairo_text_extents(cr_, text.c_str(), &extents);
    return extents.x_advance;
}

void Canvas::text(double x, double y, const std::string& text, Align align) {
    const double shift = align == Align::start ? 0 : align == Align::middle ? 0.5 : 1;
    cairo_move_to(cr_, x - shift * text_width(text), y);
    cairo_show_text(cr_, text.c_str());
}

void Canvas::text_upwards(double x, double y, const std::string& text) {
    cairo_save(cr_);
    cairo_translate(cr_, x, y);
    cairo_rotate(cr_, -std::numbers::pi / 2);
    cairo_move_to(cr_, -0.5 * text_width(text), 0);
    cairo_show_text(cr_, text.c_str());
    cairo_restore(cr_);
}

void Canvas::picture(const Image& image, double x, double y, double w, double h) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
    require(cairo_surface_status(surface.get()));
    unsigned char* const rows = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int j = 0; j < image.height; ++j) {
        for (int i = 0; i < image.width; ++i) {
            const std::uint8_t* p = image.at(i, j);
            const std::uint32_t value = std::uint32_t{p[0]} << 16 | std::uint32_t{p[1]} << 8 | p[2];
            std::memcpy(rows + static_cast<std::ptrdiff_t>(j) * stride + 4 * i, &value, sizeof value);
        }
    }
    cairo_surface_mark_dirty(surface.get());
    cairo_save(cr_);
    cairo_translate(cr_, x, y);
    cairo_scale(cr_, w / image.width, h / image.height);
    cairo_set_source_surface(cr_, surface.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr_), CAIRO_FILTER_NEAREST);
    cairo_paint(cr_);
    cairo_restore(cr_);
}

std::string canvas_svg(int width, int height, const std::function<void(Canvas&)>& draw) {
    std::string svg;
    {
        const Surface surface(cairo_svg_surface_create_for_stream(append, &svg, width, height));
        cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
        draw_on(surface.get(), 1, draw);
        cairo_surface_finish(surface.get());
        require(cairo_surface_status(surface.get()));
    }
    return with_own_names(svg);
}

std::string canvas_pdf(int width, int height, const std::function<void(Canvas&)>& draw) {
    std::string pdf;
    const Surface surface(cairo_pdf_surface_create_for_stream(append, &pdf, width, height));
    // The same figure is to be the same bytes.
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
    draw_on(surface.get(), 1, draw);
    cairo_surface_finish(surface.get());
    require(cairo_surface_status(surface.get()));
    return pdf;
}

Image canvas_image(int width, int height, double scale, const std::function<void(Canvas&)>& draw) {
    Image image;
    image.width = static_cast<int>(std::lround(width * scale));
    image.height = static_cast<int>(std::lround(height * scale));
    image.pixels.resize(static_cast<std::size_t>(image.width) * image.height * 4);
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, image.width, image.height));
    draw_on(surface.get(), scale, draw);
    cairo_surface_flush(surface.get());
    const unsigned char* const rows = cairo_image_surface_get_data(surface.get());
    const int stride = cairo_image_surface_get_stride(surface.get());
    for (int j = 0; j < image.height; ++j) {
        for (int i = 0; i < image.width; ++i) {
            std::uint32_t value = 0;
            std::memcpy(&value, rows + static_cast<std::ptrdiff_t>(j) * stride + 4 * i, sizeof value);
            std::uint8_t* p = image.at(i, j);
            p[0] = static_cast<std::uint8_t>(value >> 16);
            p[1] = static_cast<std::uint8_t>(value >> 8);
            p[2] = static_cast<std::uint8_t>(value);
            p[3] = 255;
        }
    }
    return image;
}

}  // namespace unravel::tool
