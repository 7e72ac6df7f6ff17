#include "tool/study/verify/verify_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tool/report/html.hpp"

namespace unravel::tool {

namespace {

std::string number(double value) {
    return std::isfinite(value) ? fmt::format("{:.4g}", value) : "–";
}

std::string step_text(double step) {
    return step > 0 ? fmt::format("1/{:.0f} s", 1 / step) : "–";
}

std::string tolerance_text(const VerifyLine& line) {
    const double share = line.expected != 0 ? line.tolerance / std::abs(line.expected) : 0;
    return share > 0 && share < 0.5 ? fmt::format("{:.2g} %", 100 * share) : number(line.tolerance);
}

std::string verdict_of(const VerifyLine& line) {
    if (!line.failure.empty()) return "fails: " + line.failure;
    return line.holds() ? "holds" : "off";
}

// Lines of one setting of a case, which follow each other.
std::vector<std::vector<const VerifyLine*>> by_setting(const VerifyOutcome& outcome) {
    std::vector<std::vector<const VerifyLine*>> out;
    for (const VerifyLine& line : outcome.result.lines) {
        const bool same = !out.empty() && out.back().front()->of == line.of &&
                          out.back().front()->expected == line.expected;
        if (!same) out.emplace_back();
        out.back().push_back(&line);
    }
    return out;
}

struct Row {
    std::vector<std::string> cells;
    bool holds = true;
};

const std::vector<std::string> summary_head{"case",     "set to",    "quantity",       "expected",
                                            "measured", "tolerance", "lines that hold"};
const std::vector<std::string> detail_head{"set to",   "grid",      "step",   "expected",
                                           "measured", "tolerance", "verdict"};

std::vector<Row> summary_rows(const std::vector<VerifyOutcome>& outcomes) {
    std::vector<Row> rows;
    for (const VerifyOutcome& outcome : outcomes) {
        for (const auto& lines : by_setting(outcome)) {
            double low = INFINITY, high = -INFINITY;
            int holding = 0;
            for (const VerifyLine* line : lines) {
                holding += line->holds();
                if (!std::isfinite(line->measured)) continue;
                low = std::min(low, line->measured);
                high = std::max(high, line->measured);
            }
            const std::string unit = *outcome.of->unit ? fmt::format(" {}", outcome.of->unit) : "";
            const std::string measured = low == high ? number(low) : number(low) + " … " + number(high);
            rows.push_back({{outcome.of->name, lines.front()->of, outcome.of->quantity,
                             number(lines.front()->expected) + unit, measured + unit,
                             tolerance_text(*lines.front()), fmt::format("{} of {}", holding, lines.size())},
                            holding == static_cast<int>(lines.size())});
        }
    }
    return rows;
}

std::vector<Row> detail_rows(const VerifyOutcome& outcome) {
    std::vector<Row> rows;
    for (const VerifyLine& line : outcome.result.lines) {
        rows.push_back({{line.of, line.grid, step_text(line.step), number(line.expected),
                         number(line.measured), tolerance_text(line), verdict_of(line)},
                        line.holds()});
    }
    return rows;
}

std::string markdown_table(const std::vector<std::string>& head, const std::vector<Row>& rows) {
    std::string text = "|";
    for (const std::string& name : head) text += " " + name + " |";
    text += "\n|";
    for (std::size_t k = 0; k < head.size(); ++k) text += "---|";
    text += "\n";
    for (const Row& row : rows) {
        text += "|";
        for (const std::string& cell : row.cells) text += " " + cell + " |";
        text += "\n";
    }
    return text;
}

std::string html_table(const std::vector<std::string>& head, const std::vector<Row>& rows) {
    std::string text = "<table><tr>";
    for (const std::string& name : head) text += "<th>" + html_text(name) + "</th>";
    text += "</tr>\n";
    for (const Row& row : rows) {
        text += row.holds ? "<tr>" : "<tr class=\"off\">";
        for (const std::string& cell : row.cells) text += "<td>" + html_text(cell) + "</td>";
        text += "</tr>\n";
    }
    return text + "</table>\n";
}

std::string about(const VerifyCase& of) {
    const std::string why = *of.why ? fmt::format(" Tolerance: {}.", of.why) : "";
    return fmt::format("{} — {} ({}).{}", of.quantity, of.formula, of.source, why);
}

}  // namespace

std::string verify_summary(const std::vector<VerifyOutcome>& outcomes) {
    return markdown_table(summary_head, summary_rows(outcomes));
}

std::string verify_markdown(const std::vector<VerifyOutcome>& outcomes) {
    std::string text = "# Physics against theory\n\n" + verify_summary(outcomes);
    for (const VerifyOutcome& outcome : outcomes) {
        text += fmt::format("\n## {}\n\n{}\n\n", outcome.of->name, about(*outcome.of));
        text += markdown_table(detail_head, detail_rows(outcome));
    }
    return text;
}

std::string verify_html(const std::vector<VerifyOutcome>& outcomes) {
    std::string text =
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Physics against theory</title>\n"
        "<style>body{font:15px/1.45 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#1e2228}"
        "table{border-collapse:collapse;margin:1em 0}td,th{border-bottom:1px solid #d5d9df;padding:.25em "
        ".7em;"
        "text-align:left}.off td{background:#fbe3e1}svg{max-width:100%;height:auto}</style>\n"
        "<h1>Physics against theory</h1>\n";
    text += html_table(summary_head, summary_rows(outcomes));
    for (const VerifyOutcome& outcome : outcomes) {
        text += fmt::format("<h2>{}</h2>\n<p>{}</p>\n", html_text(outcome.of->name),
                            html_text(about(*outcome.of)));
        if (outcome.result.plot) {
            const std::string svg = plot_svg(*outcome.result.plot);
            const std::size_t start = svg.find("<svg");  // without the declaration of a file of its own
            text += start == std::string::npos ? svg : svg.substr(start);
        }
        text += html_table(detail_head, detail_rows(outcome));
    }
    return text + "</html>\n";
}

nlohmann::ordered_json verify_json(const std::vector<VerifyOutcome>& outcomes) {
    auto json = nlohmann::ordered_json::array();
    for (const VerifyOutcome& outcome : outcomes) {
        nlohmann::ordered_json of{
            {"name", outcome.of->name},      {"formula", outcome.of->formula},
            {"source", outcome.of->source},  {"quantity", outcome.of->quantity},
            {"unit", outcome.of->unit},      {"seconds", outcome.seconds},
            {"holds", outcome.wrong() == 0}, {"lines", nlohmann::ordered_json::array()}};
        for (const VerifyLine& line : outcome.result.lines) {
            of["lines"].push_back({{"of", line.of},
                                   {"grid", line.grid},
                                   {"step", line.step},
                                   {"expected", line.expected},
                                   {"measured", line.measured},
                                   {"tolerance", line.tolerance},
                                   {"holds", line.holds()},
                                   {"failure", line.failure}});
        }
        json.push_back(of);
    }
    return json;
}

std::string terminal_text(const VerifyOutcome& outcome) {
    const std::size_t all = outcome.result.lines.size();
    std::string text = fmt::format("{:<16} {} of {} lines hold  ({:.1f} s)", outcome.of->name,
                                   all - static_cast<std::size_t>(outcome.wrong()), all, outcome.seconds);
    for (const VerifyLine& line : outcome.result.lines) {
        if (line.holds()) continue;
        text +=
            fmt::format("\n    {} {} {}: {} {}, expected {} ({})", line.of, line.grid, step_text(line.step),
                        number(line.measured), outcome.of->unit, number(line.expected), verdict_of(line));
    }
    return text;
}

}  // namespace unravel::tool
