#include "sim/run/stats.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>

namespace unravel::sim {

namespace {

using R = const StepReport&;

std::string milliseconds(double seconds) {
    return fmt::format("{:.4f}", 1e3 * seconds);
}

// Stage times by column name: one list for writing and for reading back.
struct TimeColumn {
    const char* name;
    double StageTimes::*slot;
};
constexpr std::array<TimeColumn, 10> time_columns{{{"ms_contact", &StageTimes::contact},
                                                   {"ms_collision", &StageTimes::collision},
                                                   {"ms_air", &StageTimes::air},
                                                   {"ms_forces", &StageTimes::forces},
                                                   {"ms_graph", &StageTimes::graph},
                                                   {"ms_assembly", &StageTimes::assembly},
                                                   {"ms_solve", &StageTimes::solve},
                                                   {"ms_advance", &StageTimes::advance},
                                                   {"ms_measure", &StageTimes::measure},
                                                   {"ms_compare", &StageTimes::compare}}};

template <std::size_t K>
std::string time_text(R r) {
    return milliseconds(r.times.*time_columns[K].slot);
}

constexpr StatsColumn columns[] = {
    {"step", "number of the step, 1 for the first", [](R r) { return fmt::format("{}", r.step); }},
    {"t", "time at its end [s]", [](R r) { return fmt::format("{}", r.t); }},
    {"h", "step size [s]", [](R r) { return fmt::format("{}", r.h); }},
    {"components", "independent components", [](R r) { return fmt::format("{}", r.components); }},
    {"largest", "particles of the largest component", [](R r) { return fmt::format("{}", r.largest); }},
    {"constrained", "particles without a free direction",
     [](R r) { return fmt::format("{}", r.constrained); }},
    {"partly", "particles with one or two free directions", [](R r) { return fmt::format("{}", r.partly); }},
    {"implicit", "stretch and shear springs handled implicitly",
     [](R r) { return fmt::format("{}", r.implicit); }},
    {"explicit", "those handled explicitly", [](R r) { return fmt::format("{}", r.explicit_); }},
    {"inactive", "those slack", [](R r) { return fmt::format("{}", r.inactive); }},
    {"cg_iterations", "CG iterations, summed over components",
     [](R r) { return fmt::format("{}", r.cg_iterations); }},
    {"cg_iterations_max", "CG iterations of the component that took most",
     [](R r) { return fmt::format("{}", r.cg_iterations_max); }},
    {"rvm", "row-vector multiplies: block rows multiplied, over iterations and components",
     [](R r) { return fmt::format("{}", r.rvm); }},
    {"rvm_whole", "what the undecomposed solver needs for the same system; empty unless compared",
     [](R r) { return r.rvm_whole ? fmt::format("{}", *r.rvm_whole) : std::string(); }},
    {"converged", "1 if every component reached the tolerance",
     [](R r) { return fmt::format("{:d}", r.converged); }},
    {"substeps", "parts into which an explicit step was divided",
     [](R r) { return fmt::format("{}", r.substeps); }},
    {"rejected", "adaptive step: larger steps tried before this one and undone",
     [](R r) { return fmt::format("{}", r.rejected); }},
    {"contacts", "particle-solid contacts", [](R r) { return fmt::format("{}", r.contacts); }},
    {"self_contacts", "temporary springs of self-collision",
     [](R r) { return fmt::format("{}", r.self_contacts); }},
    {"self_distance",
     "least distance of particles that may collide, at most the thickness [m]; 0 without self-collision",
     [](R r) { return fmt::format("{}", r.self_distance); }},
    {"pulling", "contacts with solids that stay though they pull",
     [](R r) { return fmt::format("{}", r.pulling); }},
    {"crossings",
     "edges of cloth through faces of cloth, counted at frames; empty elsewhere, and with a single cloth "
     "without self-collision",
     [](R r) { return r.crossings ? fmt::format("{}", *r.crossings) : std::string(); }},
    {"in_solids",
     "edges of cloth that pass through solids, counted at frames; empty elsewhere, and without solids of a "
     "closed form",
     [](R r) { return r.in_solids ? fmt::format("{}", *r.in_solids) : std::string(); }},
    {"deepest", "how far cloth is inside a solid, at frames [m]; empty as `in_solids`",
     [](R r) { return r.in_solids ? fmt::format("{}", r.deepest) : std::string(); }},
    {"max_strain", "largest (l - L)/L of the stretch springs",
     [](R r) { return fmt::format("{}", r.max_strain); }},
    {"p99_strain", "its 99th percentile", [](R r) { return fmt::format("{}", r.p99_strain); }},
    {"lowest", "lowest particle's height [m]", [](R r) { return fmt::format("{}", r.lowest); }},
    {"kinetic", "kinetic energy [J]", [](R r) { return fmt::format("{}", r.kinetic); }},
    {"potential", "springs' and gravity's energy [J]", [](R r) { return fmt::format("{}", r.potential); }},
    {"ms_contact", "time: constraints and contact [ms]", time_text<0>, true},
    {"ms_collision", "time: self-collision [ms]; 0 without it", time_text<1>, true},
    {"ms_air", "time: air [ms]; 0 without wind", time_text<2>, true},
    {"ms_forces", "time: forces and splitting [ms]", time_text<3>, true},
    {"ms_graph", "time: graph search [ms]", time_text<4>, true},
    {"ms_assembly", "time: assembling A and b [ms]", time_text<5>, true},
    {"ms_solve", "time: CG [ms]", time_text<6>, true},
    {"ms_advance", "time: advancing the state [ms]", time_text<7>, true},
    {"ms_measure", "time: strain and energy [ms]", time_text<8>, true},
    {"ms_compare", "time: the undecomposed solve, where compared [ms]", time_text<9>, true},
};

std::vector<std::string_view> split(std::string_view line, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t end; (end = line.find(at)) != line.npos; line.remove_prefix(end + 1)) {
        parts.push_back(line.substr(0, end));
    }
    parts.push_back(line);
    return parts;
}

template <typename T>
bool parse(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::span<const StatsColumn> stats_columns() {
    return columns;
}

std::string stats_header() {
    std::string csv;
    for (const StatsColumn& column : columns)
        csv += csv.empty() ? column.name : fmt::format(",{}", column.name);
    return csv + '\n';
}

std::string stats_rows(std::span<const StepReport> reports) {
    std::string csv;
    for (const StepReport& report : reports) {
        for (const StatsColumn& column : columns) {
            if (&column != columns) csv += ',';
            csv += column.text(report);
        }
        csv += '\n';
    }
    return csv;
}

void take_times(const std::string& csv, std::span<StepReport> reports) {
    const std::vector<std::string_view> lines = split(csv, '\n');
    const std::vector<std::string_view> header = split(lines.front(), ',');
    if (header.empty() || header.front() != "step") return;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const std::vector<std::string_view> cells = split(lines[k], ',');
        std::uint64_t step = 0;
        if (cells.size() != header.size() || !parse(cells[0], step) || step < 1 || step > reports.size())
            continue;
        StepReport& report = reports[step - 1];
        for (std::size_t c = 0; c < header.size(); ++c) {
            for (const TimeColumn& column : time_columns) {
                double value = 0;
                if (header[c] == column.name && parse(cells[c], value))
                    report.times.*column.slot = 1e-3 * value;
            }
        }
    }
}

}  // namespace unravel::sim
