#include <algorithm>

#include "tool/picture/view.hpp"
#include "tool/report/page.hpp"

namespace unravel::tool {

namespace {

// A table of hundreds of rows per frame would tell nobody anything and outweigh the pictures.
constexpr std::size_t rows_shown = 24;

}  // namespace

PageRecorder::PageRecorder(const ClothModel& model, const std::filesystem::path& folder)
    : model_(model), edges_(drawn_edges(model)), rows_(folder) {}

void PageRecorder::add(const FrameRecord& record) {
    const std::vector<Rgb>& colors = colors_.assign(record.component, edges_);
    PageFrame frame;
    frame.number = record.frame;
    frame.time = record.state.t;
    if (!record.reports.empty()) {
        frame.first_step = record.reports.front().step;
        frame.last_step = record.reports.back().step;
    }
    std::vector<ComponentRow> table =
        component_table(model_, record.component, record.springs, record.solves, colors);
    for (std::size_t k = rows_shown; k < table.size(); ++k) {
        const ComponentRow& row = table[k];
        ++frame.rest.count;
        frame.rest.particles += row.particles;
        frame.rest.springs += row.springs;
        frame.rest.iterations += row.solve.iterations;
        frame.rest.rvm += row.solve.rvm;
    }
    frame.first_row = rows_.size();
    frame.rows = std::min(table.size(), rows_shown);
    rows_.append(std::span(table).first(frame.rows));
    frames_.push_back(std::move(frame));
}

}  // namespace unravel::tool
