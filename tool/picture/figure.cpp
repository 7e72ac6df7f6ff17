#include "tool/picture/figure.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "render/palette.hpp"
#include "sim/model/surface.hpp"
#include "tool/picture/wire_colors.hpp"

namespace unravel::tool {

namespace {

constexpr Rgb white{255, 255, 255}, black{0, 0, 0}, line_ink{70, 74, 82}, no_one{214, 216, 220};
constexpr std::size_t nobody = static_cast<std::size_t>(-1);

// Pixels between particles from which on they, and springs, are drawn.
constexpr float least_dots = 5, least_wires = 3.5f;

Rgb blended(Rgb a, Rgb b, double t) {
    const auto channel = [t](std::uint8_t x, std::uint8_t y) {
        return static_cast<std::uint8_t>(x + t * (y - x) + 0.5);
    };
    return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

// A colour dark enough for a line on white.
Rgb page_ink(Rgb c) {
    const double light = 0.30 * c.r + 0.59 * c.g + 0.11 * c.b;
    return blended(c, black, std::clamp((light - 110) / 255 + 0.12, 0.12, 0.5));
}

bool has_scale(Show show) {
    return show == Show::strain || show == Show::velocity;
}

}  // namespace

/// One frame on its page.
struct PaperFigure::Page {
    Canvas& canvas;
    const FrameRecord& record;
    const DrawFrame& frame;
    PageView view;
    Vec3f lamp{0, 1, 0};
    float gap = 0;                    // px between particles
    std::vector<PagePoint> points{};  // (particles)
    std::vector<Rgb> own{}, tint{};   // (cells) of their particles; as painted
    // Where in the order of painting springs and particles go: on the nearest of their cells. nobody: on
    // none.
    std::vector<std::size_t> spring_place{}, particle_place{};

    bool wires() const { return gap >= least_wires; }
    double line() const { return std::clamp(0.09 * gap, 0.35, 1.4); }
};

PaperFigure::PaperFigure(const Scene& scene, const ClothModel& model, const DrawScene& drawn)
    : scene_(&scene), model_(&model), drawn_(&drawn), solids_(drawn) {
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> spring_of;
    for (std::uint32_t s = 0; s < drawn.edges.size(); ++s) {
        const auto [a, b] = drawn.edges[s];
        spring_of.try_emplace({std::min(a, b), std::max(a, b)}, s);
    }
    spring_cells_.assign(drawn.edges.size(), {-1, -1});
    for (const ClothPatch& patch : model.cloths) {
        for (const ClothSurface::Face& face : surface_of(patch).faces) {
            Cell cell;
            cell.corners = face.corners;
            cell.first = static_cast<std::uint32_t>(springs_.size());
            for (std::size_t k = 0; k < face.corners; ++k) cell.corner[k] = patch.first + face.vertex[k];
            for (std::size_t k = 0; k < face.corners; ++k)
                for (std::size_t l = k + 1; l < face.corners; ++l) {
                    const std::uint32_t a = cell.corner[k], b = cell.corner[l];
                    const auto found = spring_of.find({std::min(a, b), std::max(a, b)});
                    if (found == spring_of.end()) continue;
                    const bool side = l == k + 1 || (k == 0 && l + 1 == face.corners);
                    springs_.push_back({found->second, side});
                    if (!side) continue;
                    std::array<std::int32_t, 2>& both = spring_cells_[found->second];
                    both[both[0] < 0 ? 0 : 1] = static_cast<std::int32_t>(cells_.size());
                }
            cell.last = static_cast<std::uint32_t>(springs_.size());
            cells_.push_back(cell);
        }
    }
}

/// Cells wear their particles' colour where those agree, crisply, and a grey where they do not; of a scale
/// their mean. Tilted away from the lamp they are darker.
void PaperFigure::tint_cells(Page& page) const {
    const std::vector<Rgb>& colors = page.frame.particle_colors;
    const bool scale = has_scale(scene_->look.show);
    const double strength = scale || !page.wires() ? 0.85 : 0.5;
    page.own.resize(cells_.size());
    page.tint.resize(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        const Cell& cell = cells_[c];
        const std::span<const std::uint32_t> corners(cell.corner.data(), cell.corners);
        Rgb color = white;
        if (scale) {
            std::array<int, 3> sum{};
            for (const std::uint32_t p : corners) {
                sum[0] += colors[p].r;
                sum[1] += colors[p].g;
                sum[2] += colors[p].b;
            }
            const auto mean = [&](int k) { return static_cast<std::uint8_t>(sum[k] / cell.corners); };
            color = {mean(0), mean(1), mean(2)};
        } else {
            for (const std::uint32_t p : corners) {
                if (page.record.free[p] == 0) continue;
                if (color == white) color = colors[p];
                if (color != colors[p]) color = no_one;
            }
        }
        page.own[c] = color;
        const std::vector<Vec3f>& x = page.frame.positions;
        const Vec3f normal =
            (x[corners[1]] - x[corners[0]]).cross(x[corners[2]] - x[corners[0]]).normalized();
        const float side = normal.dot(page.view.eye() - x[corners[0]]) >= 0 ? 1.f : -1.f;
        const float lit = 0.5f + 0.5f * side * normal.dot(page.lamp);
        page.tint[c] =
            blended(black, blended(white, color, strength), 0.70 + 0.30 * std::clamp(lit, 0.f, 1.f));
    }
}

void PaperFigure::draw_spring(Page& page, std::size_t spring) const {
    const auto [a, b] = drawn_->edges[spring];
    const PagePoint &p = page.points[a], &q = page.points[b];
    if (!(p.depth > 0) || !(q.depth > 0)) return;
    const std::vector<Rgb>& colors = page.frame.particle_colors;
    const bool faint = page.frame.edge_strength[spring] < 255;
    Rgb color = line_ink;
    if (!page.frame.edge_colors.empty())
        color = page.frame.edge_colors[spring];
    else if (page.record.free[a] == 0 || colors[a] == colors[b])
        color = colors[b];
    else if (page.record.free[b] == 0)
        color = colors[a];
    if (color == white) color = line_ink;
    page.canvas.color(faint ? blended(page_ink(color), white, 0.55) : page_ink(color));
    page.canvas.width(faint ? 0.6 * page.line() : page.line());
    page.canvas.line(p.x, p.y, q.x, q.y);
}

void PaperFigure::draw_particle(Page& page, std::size_t particle) const {
    const PagePoint& p = page.points[particle];
    if (!(p.depth > 0)) return;
    const double radius = std::clamp(0.15 * page.gap, 0.9, 3.2);
    if (page.record.free[particle] != 0) {
        page.canvas.color(page_ink(page.frame.particle_colors[particle]));
        page.canvas.disc(p.x, p.y, radius);
        return;
    }
    page.canvas.color(line_ink);
    page.canvas.disc(p.x, p.y, radius + 0.25 * radius);
    page.canvas.color(white);
    page.canvas.disc(p.x, p.y, 0.62 * radius);
}

/// Between cells of different colours, and where the cloth ends.
void PaperFigure::draw_outline(Page& page, std::size_t spring) const {
    const auto [one, other] = spring_cells_[spring];
    if (one < 0) return;
    if (other >= 0 && page.own[static_cast<std::size_t>(one)] == page.own[static_cast<std::size_t>(other)])
        return;
    const auto [a, b] = drawn_->edges[spring];
    page.canvas.color(line_ink);
    page.canvas.width(other < 0 ? 0.9 : 0.6);
    page.canvas.line(page.points[a].x, page.points[a].y, page.points[b].x, page.points[b].y);
}

/// A cell, and on it the springs and particles whose nearest cell it is; `place`: its own.
void PaperFigure::draw_cell(Page& page, std::size_t index, std::size_t place) const {
    const Cell& cell = cells_[index];
    const std::span<const std::uint32_t> corners(cell.corner.data(), cell.corners);
    const PagePoint& start = page.points[corners[0]];
    page.canvas.move_to(start.x, start.y);
    for (const std::uint32_t p : corners.subspan(1)) page.canvas.line_to(page.points[p].x, page.points[p].y);
    page.canvas.color(page.tint[index]);
    if (page.wires()) {
        page.canvas.fill();
    } else {
        page.canvas.width(0.6);
        page.canvas.fill_and_stroke();  // no hairlines of white between neighbours
    }
    for (std::uint32_t k = cell.first; k < cell.last; ++k) {
        if (page.spring_place[springs_[k].spring] != place) continue;
        if (page.wires())
            draw_spring(page, springs_[k].spring);
        else if (!has_scale(scene_->look.show))
            draw_outline(page, springs_[k].spring);
    }
    if (page.gap < least_dots) return;
    for (const std::uint32_t p : corners)
        if (page.particle_place[p] == place) draw_particle(page, p);
}

void PaperFigure::paint(Page& page) const {
    const std::vector<FigureSolids::Layer> layers = solids_.seen(page.frame, page.view, page.lamp);
    const float yields = std::min(0.012f, 0.5f * drawn_->spacing);
    struct Item {
        std::size_t layer;
        float depth;
        std::size_t cell;
    };
    std::vector<Item> items;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
        std::array<PagePoint, 4> corner;
        float depth = 0;
        bool seen = true;
        for (std::size_t k = 0; k < cells_[c].corners; ++k) {
            corner[k] = page.points[cells_[c].corner[k]];
            depth += corner[k].depth / static_cast<float>(cells_[c].corners);
            seen = seen && corner[k].depth > 0;
        }
        if (seen)
            items.push_back(
                {FigureSolids::layer_of({corner.data(), cells_[c].corners}, layers, page.view, yields), depth,
                 c});
    }
    std::ranges::stable_sort(items, [](const Item& a, const Item& b) {
        return a.layer != b.layer ? a.layer < b.layer : a.depth > b.depth;
    });
    page.spring_place.assign(drawn_->edges.size(), nobody);
    page.particle_place.assign(model_->size(), nobody);
    for (std::size_t place = 0; place < items.size(); ++place) {
        const Cell& cell = cells_[items[place].cell];
        for (std::uint32_t k = cell.first; k < cell.last; ++k) page.spring_place[springs_[k].spring] = place;
        for (std::size_t k = 0; k < cell.corners; ++k) page.particle_place[cell.corner[k]] = place;
    }
    std::size_t next = 0;
    for (std::size_t l = 0; l <= layers.size(); ++l) {
        for (; next < items.size() && items[next].layer == l; ++next) draw_cell(page, items[next].cell, next);
        if (l == layers.size()) break;
        for (const FigureSolids::Triangle& t : layers[l].triangles) {
            const auto grey = static_cast<std::uint8_t>(196 + 50 * t.shade);
            page.canvas.color({grey, grey, grey});
            page.canvas.width(0.5);
            page.canvas.move_to(t.corner[0].x, t.corner[0].y);
            page.canvas.line_to(t.corner[1].x, t.corner[1].y);
            page.canvas.line_to(t.corner[2].x, t.corner[2].y);
            page.canvas.fill_and_stroke();
        }
    }
    // Ribbons one particle wide have no cells.
    for (std::size_t s = 0; s < drawn_->edges.size(); ++s)
        if (page.spring_place[s] == nobody && spring_cells_[s][0] < 0) draw_spring(page, s);
    for (std::size_t p = 0; p < model_->size(); ++p)
        if (page.particle_place[p] == nobody && cells_.empty()) draw_particle(page, p);
}

void PaperFigure::draw(Canvas& canvas, const FrameRecord& record, const DrawFrame& frame, int width,
                       int height) const {
    Page page{.canvas = canvas, .record = record, .frame = frame, .view = {frame.camera, width, height}};
    // Over the viewer's left shoulder, as in the picture for a screen.
    const Vec3f back = (frame.camera.position - frame.camera.target).normalized();
    const Vec3f left = back.cross(frame.camera.up).normalized();
    page.lamp = (back + 0.6f * left + 0.5f * frame.camera.up).normalized();
    Vec3f middle = Vec3f::Zero();
    for (std::size_t p = 0; p < model_->size(); ++p) {
        page.points.push_back(page.view(frame.positions[p]));
        middle += frame.positions[p] / static_cast<float>(model_->size());
    }
    page.gap = drawn_->spacing * page.view.pixels() / std::max((middle - page.view.eye()).norm(), 1e-3f);
    tint_cells(page);
    paint(page);
}

Image figure_picture(const PaperFigure& figure, const FrameRecord& record, const DrawFrame& frame, int width,
                     int height) {
    return canvas_image(width, height, 1,
                        [&](Canvas& canvas) { figure.draw(canvas, record, frame, width, height); });
}

}  // namespace unravel::tool
