#include "tool/plot/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "tool/plot/canvas.hpp"
#include "tool/plot/ticks.hpp"

namespace unravel::tool {

namespace {

constexpr Rgb plot_ink{40, 44, 52}, pale{222, 226, 232}, plot_grey{110, 116, 126};
constexpr double text_size = 12.5, note_size = 10.5;
constexpr double note_gap = 6;  // between a point and what is written beside it

// Data along one axis to the page.
struct Scale {
    bool log = false;
    double from = 0, to = 1, page_from = 0, page_to = 1;

    bool holds(double value) const { return std::isfinite(value) && (!log || value > 0); }
    double operator()(double value) const {
        const double share =
            log ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
        return page_from + share * (page_to - page_from);
    }
};

// Lines on white: Okabe & Ito's (2008), with a darker yellow, and three more.
constexpr std::array<Rgb, 10> series_colors{{{230, 159, 0},
                                             {86, 180, 233},
                                             {0, 158, 115},
                                             {176, 152, 0},
                                             {0, 114, 178},
                                             {213, 94, 0},
                                             {204, 121, 167},
                                             {170, 43, 0},
                                             {170, 213, 170},
                                             {140, 60, 255}}};

Rgb series_color(const Plot& plot, std::size_t k) {
    // Blue, vermilion, green, pink …: those that differ most come first.
    constexpr std::size_t order[] = {4, 5, 2, 6, 0, 1, 9, 7, 3, 8};
    constexpr Rgb faint_grey{190, 194, 200};
    if (plot.series[k].faint) return faint_grey;
    const int asked = plot.series[k].color;
    return series_colors[asked >= 0 ? static_cast<std::size_t>(asked) % series_colors.size()
                                    : order[k % std::size(order)]];
}

Scale scale_of(const Plot& plot, bool along_x) {
    const PlotAxis& axis = along_x ? plot.x : plot.y;
    Scale scale;
    scale.log = axis.log;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool bars = false;
    const auto extend = [&](double value) {
        if (!scale.holds(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    };
    for (const PlotSeries& series : plot.series) {
        bars = bars || series.style == SeriesStyle::bars;
        for (const PlotPoint& p : series.points) {
            if (along_x) {
                for (const double value : {p.x, p.left, p.right}) extend(value);
            } else {
                for (const double value : {p.y, p.low, p.high}) extend(value);
            }
        }
    }
    for (const PlotGuide& guide : plot.guides) {
        if (guide.horizontal != along_x) extend(guide.value);
    }
    if (low > high) low = scale.log ? 1 : 0, high = scale.log ? 10 : 1;
    if (scale.log) {
        const double margin = std::pow(std::max(high / low, 1.5), 0.06);
        low /= margin;
        high *= margin;
    } else {
        if (!along_x && (bars || (low > 0 && low < 0.4 * high))) low = std::min(low, 0.0);
        const double margin = high > low ? 0.05 * (high - low) : std::max(0.05 * std::abs(high), 0.5);
        if (low != 0 || along_x) low -= margin;
        high += margin;
    }
    if (!axis.categories.empty()) low = -0.6, high = static_cast<double>(axis.categories.size()) - 0.4;
    scale.from = axis.from.value_or(low);
    scale.to = axis.to.value_or(high);
    return scale;
}

std::vector<Tick> ticks_of(const PlotAxis& axis, const Scale& scale, int wanted) {
    if (axis.categories.empty())
        return scale.log ? log_ticks(scale.from, scale.to) : linear_ticks(scale.from, scale.to, wanted);
    std::vector<Tick> ticks;
    for (std::size_t k = 0; k < axis.categories.size(); ++k)
        ticks.push_back({static_cast<double>(k), axis.categories[k]});
    return ticks;
}

// One drawing of a plot.
class Drawing {
public:
    Drawing(const Plot& plot, Canvas& canvas) : plot_(plot), c_(canvas) {}

    void draw() {
        lay_out();
        axes();
        c_.clip(left_, top_ - 8, right_ - left_, bottom_ - top_ + 16);
        bars();
        guides();
        for (std::size_t k = 0; k < plot_.series.size(); ++k) {
            if (plot_.series[k].style != SeriesStyle::bars) series(k);
        }
        c_.unclip();
        labels_of_points();
        legend();
    }

private:
    void lay_out() {
        x_ = scale_of(plot_, true);
        y_ = scale_of(plot_, false);
        x_ticks_ = ticks_of(plot_.x, x_, std::max(3, plot_.width / 110));
        y_ticks_ = ticks_of(plot_.y, y_, std::max(3, plot_.height / 70));
        c_.font(text_size);
        double widest = 0, names = 0;
        for (const Tick& tick : y_ticks_) widest = std::max(widest, c_.text_width(tick.label));
        for (const PlotSeries& s : plot_.series) {
            if (!s.label.empty()) names = std::max(names, c_.text_width(s.label));
        }
        left_ = widest + 14 + (plot_.y.label.empty() ? 6 : 26);
        right_ = plot_.width - (names > 0 ? names + 52 : 20);
        top_ = plot_.title.empty() ? 18 : 40;
        bottom_ = plot_.height - (plot_.x.label.empty() ? 30 : 50);
        x_.page_from = left_, x_.page_to = right_;
        y_.page_from = bottom_, y_.page_to = top_;
    }

    void axes() {
        c_.width(1);
        for (const Tick& tick : x_ticks_) {
            c_.color(pale, tick.label.empty() ? 0.55 : 1);
            if (plot_.x.categories.empty()) c_.line(x_(tick.value), top_, x_(tick.value), bottom_);
            c_.color(plot_ink);
            c_.text(x_(tick.value), bottom_ + 17, tick.label, Align::middle);
        }
        for (const Tick& tick : y_ticks_) {
            c_.color(pale, tick.label.empty() ? 0.55 : 1);
            c_.line(left_, y_(tick.value), right_, y_(tick.value));
            c_.color(plot_ink);
            c_.text(left_ - 8, y_(tick.value) + 4.5, tick.label, Align::end);
        }
        c_.color(plot_grey);
        c_.frame(left_, top_, right_ - left_, bottom_ - top_);
        c_.color(plot_ink);
        c_.text((left_ + right_) / 2, bottom_ + 40, plot_.x.label, Align::middle);
        if (!plot_.y.label.empty()) c_.text_upwards(16, (top_ + bottom_) / 2, plot_.y.label);
        c_.font(14.5, true);
        c_.text(left_, 24, plot_.title);
        c_.font(text_size);
    }

    // Groups of bars side by side, one group per x.
    void bars() {
        std::size_t count = 0, drawn = 0;
        for (const PlotSeries& s : plot_.series) count += s.style == SeriesStyle::bars;
        if (count == 0) return;
        double gap = x_.to - x_.from;
        for (const PlotSeries& s : plot_.series) {
            for (std::size_t k = 1; k < s.points.size(); ++k)
                gap = std::min(gap, std::abs(s.points[k].x - s.points[k - 1].x));
        }
        if (!plot_.x.categories.empty()) gap = 1;
        if (plot_.bar_width > 0) gap = plot_.bar_width;
        const double page = std::min(std::abs(x_(x_.from + gap) - x_(x_.from)), 120.0) * 0.8;
        const double each = page / static_cast<double>(count);
        for (std::size_t k = 0; k < plot_.series.size(); ++k) {
            if (plot_.series[k].style != SeriesStyle::bars) continue;
            for (const PlotPoint& p : plot_.series[k].points) {
                if (!x_.holds(p.x) || !y_.holds(p.y)) continue;
                const double x = x_(p.x) - page / 2 + static_cast<double>(drawn) * each;
                const double base = y_.log || y_.from > 0 ? bottom_ : y_(0), end = y_(p.y);
                c_.color(series_color(plot_, k), 0.9);
                c_.rectangle(x + 0.5, std::min(base, end), std::max(each - 1, 0.5), std::abs(end - base));
                c_.color(plot_ink);
                error_bar(x + each / 2, p);
                if (!p.note.empty()) {
                    const double above = y_.holds(p.high) ? y_(p.high) : std::min(base, end);
                    notes_.push_back({x + each / 2, above - 5, p.note, true});
                }
            }
            ++drawn;
        }
    }

    void guides() {
        for (const PlotGuide& guide : plot_.guides) {
            c_.color(plot_grey);
            c_.width(1.3);
            c_.dash(true);
            if (guide.horizontal) {
                c_.line(left_, y_(guide.value), right_, y_(guide.value));
                c_.text(right_ - 6, y_(guide.value) - 5, guide.label, Align::end);
                taken_.push_back(
                    box_of(right_ - 6 - c_.text_width(guide.label), y_(guide.value) - 5, guide.label));
            } else {
                c_.line(x_(guide.value), top_, x_(guide.value), bottom_);
                c_.text(x_(guide.value) + 5, top_ + 14, guide.label);
            }
            c_.dash(false);
        }
    }

    void series(std::size_t k) {
        const PlotSeries& s = plot_.series[k];
        c_.color(series_color(plot_, k));
        c_.width(1.8);
        c_.dash(s.dashed);
        if (s.style != SeriesStyle::points) {
            bool pen_down = false;
            for (const PlotPoint& p : s.points) {
                const bool there = x_.holds(p.x) && y_.holds(p.y);
                if (there && pen_down) c_.line_to(x_(p.x), y_(p.y));
                if (there && !pen_down) c_.move_to(x_(p.x), y_(p.y));
                pen_down = there;
            }
            c_.stroke();
        }
        c_.dash(false);
        for (const PlotPoint& p : s.points) {
            if (!x_.holds(p.x)) continue;
            const double x = x_(p.x);
            if (!std::isfinite(p.y)) {
                c_.width(1.8);
                c_.line(x - 4, top_ + 3, x + 4, top_ + 11);
                c_.line(x - 4, top_ + 11, x + 4, top_ + 3);
                if (!p.note.empty()) notes_.push_back({x, top_ + 17, p.note, false});
                continue;
            }
            if (!y_.holds(p.y)) continue;
            if (s.style != SeriesStyle::line) c_.disc(x, y_(p.y), s.faint ? 2.4 : 3.4);
            error_bar(x, p);
            if (x_.holds(p.left) && x_.holds(p.right)) {
                c_.width(1.2);
                c_.line(x_(p.left), y_(p.y), x_(p.right), y_(p.y));
            }
            if (!p.note.empty()) notes_.push_back({x, y_(p.y), p.note, false});
        }
    }

    void error_bar(double x, const PlotPoint& p) {
        if (!y_.holds(p.low) || !y_.holds(p.high)) return;
        c_.width(1.2);
        c_.line(x, y_(p.low), x, y_(p.high));
        for (const double end : {p.low, p.high}) c_.line(x - 3, y_(end), x + 3, y_(end));
    }

    struct Box {
        double left, top, right, bottom;
        bool meets(const Box& other) const {
            return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
        }
    };

    // Where text written from (x, y) on its base line stands.
    Box box_of(double x, double y, const std::string& text) const {
        return {x, y - 9, x + c_.text_width(text), y + 2};
    }

    // Beside its point, above or below, right or left of it, wherever it covers no other text; a note for
    // which there is no room is left out.
    void labels_of_points() {
        c_.color(plot_ink);
        c_.font(note_size);
        for (const Note& note : notes_) {
            if (note.centred) {
                c_.text(note.x, note.y, note.text, Align::middle);
                continue;
            }
            const double width = c_.text_width(note.text);
            for (const auto& [dx, dy] : {std::pair{note_gap, -5.0},
                                         {-note_gap - width, 11.0},
                                         {note_gap, 11.0},
                                         {-note_gap - width, -5.0}}) {
                const Box box = box_of(note.x + dx, note.y + dy, note.text);
                if (box.left < left_ || box.right > right_ || box.top < top_ || box.bottom > bottom_)
                    continue;
                if (std::any_of(taken_.begin(), taken_.end(), [&](const Box& b) { return b.meets(box); }))
                    continue;
                c_.text(note.x + dx, note.y + dy, note.text);
                taken_.push_back(box);
                break;
            }
        }
        c_.font(text_size);
    }

    void legend() {
        double y = top_ + 12;
        for (std::size_t k = 0; k < plot_.series.size(); ++k) {
            const PlotSeries& s = plot_.series[k];
            if (s.label.empty()) continue;
            c_.color(series_color(plot_, k));
            if (s.style == SeriesStyle::bars) {
                c_.rectangle(right_ + 16, y - 10, 14, 10);
            } else {
                c_.width(1.8);
                c_.dash(s.dashed);
                if (s.style != SeriesStyle::points) c_.line(right_ + 12, y - 4.5, right_ + 34, y - 4.5);
                c_.dash(false);
                if (s.style != SeriesStyle::line) c_.disc(right_ + 23, y - 4.5, 3.4);
            }
            c_.color(plot_ink);
            c_.text(right_ + 42, y, s.label);
            y += 20;
        }
    }

    // At (x, y), or beside it.
    struct Note {
        double x, y;
        std::string text;
        bool centred;
    };
    const Plot& plot_;
    Canvas& c_;
    Scale x_, y_;
    std::vector<Tick> x_ticks_, y_ticks_;
    std::vector<Note> notes_;
    std::vector<Box> taken_;  // by text
    double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
};

// Drawn one after the other to the right.
template <typename Make>
auto draw_row(std::span<const Plot> plots, const Make& make) {
    int width = 0, height = 0;
    for (const Plot& plot : plots) {
        width += plot.width;
        height = std::max(height, plot.height);
    }
    return make(width, height, [&](Canvas& canvas) {
        for (const Plot& plot : plots) {
            Drawing(plot, canvas).draw();
            canvas.move_origin(plot.width, 0);
        }
    });
}

}  // namespace

std::string plots_svg(std::span<const Plot> plots) {
    return draw_row(plots,
                    [](int width, int height, const auto& draw) { return canvas_svg(width, height, draw); });
}

Image plots_image(std::span<const Plot> plots, double scale) {
    return draw_row(plots, [scale](int width, int height, const auto& draw) {
        return canvas_image(width, height, scale, draw);
    });
}

std::string plot_svg(const Plot& plot) {
    return plots_svg({&plot, 1});
}

Image plot_image(const Plot& plot, double scale) {
    return plots_image({&plot, 1}, scale);
}

}  // namespace unravel::tool
