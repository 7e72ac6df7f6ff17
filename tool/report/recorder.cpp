#include "tool/report/page.hpp"
#include "tool/view.hpp"

namespace unravel {

namespace {

// A table of hundreds of rows per frame would tell nobody anything and outweigh the pictures.
constexpr std::size_t rows_shown = 24;

}  // namespace

PageRecorder::PageRecorder(const ClothModel& model) : model_(model), edges_(drawn_edges(model)) {}

void PageRecorder::see(const FrameRecord& record) {
    const std::vector<Rgb>& colors = colors_.assign(record.component, edges_);
    PageFrame frame;
    frame.number = record.frame;
    frame.time = record.state.t;
    if (!record.reports.empty()) {
        frame.first_step = record.reports.front().step;
        frame.last_step = record.reports.back().step;
    }
    frame.components = component_table(model_, record.component, record.springs, record.solves, colors);
    for (std::size_t k = rows_shown; k < frame.components.size(); ++k) {
        const ComponentRow& row = frame.components[k];
        ++frame.rest.count;
        frame.rest.particles += row.particles;
        frame.rest.springs += row.springs;
        frame.rest.iterations += row.solve.iterations;
        frame.rest.rvm += row.solve.rvm;
    }
    if (frame.components.size() > rows_shown) frame.components.resize(rows_shown);
    frames_.push_back(std::move(frame));
}

}  // namespace unravel
