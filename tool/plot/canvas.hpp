#pragma once

#include <cairo.h>

#include <cstdint>
#include <functional>
#include <string>

#include "render/draw_scene.hpp"
#include "render/image.hpp"
#include "tool/base/names.hpp"

namespace unravel::tool {

enum class Align { start, middle, end };

/// A page to draw on, in units of a pixel of its unscaled size, top left is (0, 0). The same calls make an
/// SVG and a picture. Text is UTF-8 in the page's one sans-serif font.
class Canvas {
public:
    explicit Canvas(cairo_t* context) : cr_(context) {}

    void color(Rgb c, double opacity = 1);
    void width(double w) { cairo_set_line_width(cr_, w); }
    void dash(bool on);
    void line(double x0, double y0, double x1, double y1);
    void rectangle(double x, double y, double w, double h);  ///< filled
    /// Many rectangles in one stroke of ink: add each, then fill().
    void add_rectangle(double x, double y, double w, double h) { cairo_rectangle(cr_, x, y, w, h); }
    void fill() { cairo_fill(cr_); }
    /// The path filled, and drawn around in the same colour.
    void fill_and_stroke() {
        cairo_close_path(cr_);
        cairo_fill_preserve(cr_);
        cairo_stroke(cr_);
    }
    void frame(double x, double y, double w, double h);  ///< outlined
    void disc(double x, double y, double radius);
    /// Path of a polyline: move to the first point, line to the others, stroke.
    void move_to(double x, double y) { cairo_move_to(cr_, x, y); }
    void line_to(double x, double y) { cairo_line_to(cr_, x, y); }
    void stroke() { cairo_stroke(cr_); }
    /// Only what lies in the rectangle is drawn, until unclip().
    void clip(double x, double y, double w, double h);
    void unclip() { cairo_restore(cr_); }
    /// What follows is drawn from this origin on.
    void move_origin(double x, double y) { cairo_translate(cr_, x, y); }
    void font(double size, bool bold = false);
    void text(double x, double y, const std::string& text, Align align = Align::start);
    void text_upwards(double x, double y, const std::string& text);  ///< turned by 90°, centred on (x, y)
    double text_width(const std::string& text) const;
    /// An opaque picture stretched over the rectangle without smoothing.
    void picture(const Image& image, double x, double y, double w, double h);

private:
    cairo_t* cr_;
};

/// What `draw` draws on a page of width × height, as an SVG document. Throws std::runtime_error where cairo
/// fails.
std::string canvas_svg(int width, int height, const std::function<void(Canvas&)>& draw);

/// The same as a PDF of one page, one point for each unit.
std::string canvas_pdf(int width, int height, const std::function<void(Canvas&)>& draw);

/// The same as a picture, `scale` pixels per unit, on white.
Image canvas_image(int width, int height, double scale, const std::function<void(Canvas&)>& draw);

}  // namespace unravel::tool
