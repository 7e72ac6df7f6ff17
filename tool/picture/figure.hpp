#pragma once

#include <array>
#include <vector>

#include "render/draw_scene.hpp"
#include "sim/model/model.hpp"
#include "sim/run/frame_record.hpp"
#include "sim/scene/scene.hpp"
#include "tool/base/names.hpp"
#include "tool/picture/figure_layers.hpp"
#include "tool/plot/canvas.hpp"

namespace unravel::tool {

/// The component view as a figure for a page: cells tinted by what their particles tell, springs as lines,
/// those of no Jacobian pale, particles as dots and fully constrained ones as open circles, on white. Where
/// particles are too dense for that, cells alone with outlines between components. The same calls make a
/// vector file and a picture.
///
/// Hidden parts are painted over: cells by depth, each with its springs and particles on it, solids as layers
/// between them.
class PaperFigure {
public:
    /// All must outlive it.
    PaperFigure(const Scene& scene, const ClothModel& model, const DrawScene& drawn);

    /// `frame`: as the renderer gets it; `width`, `height`: of the page [px].
    void draw(Canvas& canvas, const FrameRecord& record, const DrawFrame& frame, int width, int height) const;

private:
    struct Cell {
        std::array<std::uint32_t, 4> corner{};  ///< particles
        std::uint8_t corners = 0;               ///< 3 or 4
        std::uint32_t first = 0, last = 0;      ///< of springs_
    };
    struct CellSpring {
        std::uint32_t spring;
        bool side;  ///< of the cell; else a diagonal
    };
    struct Page;
    void tint_cells(Page& page) const;
    void paint(Page& page) const;
    void draw_cell(Page& page, std::size_t cell, std::size_t place) const;
    void draw_spring(Page& page, std::size_t spring) const;
    void draw_particle(Page& page, std::size_t particle) const;
    void draw_outline(Page& page, std::size_t spring) const;

    const Scene* scene_;
    const ClothModel* model_;
    const DrawScene* drawn_;
    std::vector<Cell> cells_;
    std::vector<CellSpring> springs_;                        ///< of the cells, one after the other
    std::vector<std::array<std::int32_t, 2>> spring_cells_;  ///< (springs) that they are sides of; −1: none
    FigureSolids solids_;
};

/// The figure of a frame as a picture.
Image figure_picture(const PaperFigure& figure, const FrameRecord& record, const DrawFrame& frame, int width,
                     int height);

}  // namespace unravel::tool
