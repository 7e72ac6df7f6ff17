#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tool/bench/measure_steps.hpp"
#include "tool/bench/speed_report.hpp"

namespace unravel::tool {

namespace {

// Characters, not bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// A table in Markdown whose columns are aligned in plain text too; the first to the left, others to the
// right.
class Table {
public:
    explicit Table(std::vector<std::string> head) : rows_{std::move(head)} {}
    void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
    std::string text() const {
        std::vector<std::size_t> widths(rows_.front().size(), 3);
        for (const auto& row : rows_)
            for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width_of(row[c]));
        std::string out;
        for (std::size_t r = 0; r < rows_.size(); ++r) {
            out += "|";
            for (std::size_t c = 0; c < rows_[r].size(); ++c) {
                const std::string pad(widths[c] - width_of(rows_[r][c]), ' ');
                out += c == 0 ? " " + rows_[r][c] + pad + " |" : " " + pad + rows_[r][c] + " |";
            }
            out += "\n";
            if (r > 0) continue;
            out += "|";
            for (std::size_t c = 0; c < widths.size(); ++c)
                out += std::string(widths[c] + 1, '-') + (c == 0 ? "-|" : ":|");
            out += "\n";
        }
        return out;
    }

private:
    std::vector<std::vector<std::string>> rows_;
};

// Half the spread over the median.
std::string milliseconds_text(const Spread& s) {
    const double about = 50 * (s.high - s.low) / s.median;
    return about >= 1 ? fmt::format("{:.3g} ±{:.0f}%", 1e3 * s.median, about)
                      : fmt::format("{:.3g}", 1e3 * s.median);
}

std::vector<std::string> head_of(const SpeedBench& bench, std::string first) {
    std::vector<std::string> head{std::move(first)};
    for (const SizeRecord& size : bench.sizes) head.push_back(size_name(size.particles));
    return head;
}

std::string exponent(const PowerLaw& law) {
    return law.known() ? fmt::format("{:.2f}", law.exponent) : "";
}

std::string threads_text(int threads) {
    return fmt::format("{} thread{}", threads, threads == 1 ? "" : "s");
}

std::string goals_table(const SpeedBench& bench) {
    Table table({"goal", "asked", "here", "met"});
    for (const Goal& goal : judge_goals(bench))
        table.add({goal.what, goal.bound, goal.met < 0 ? "not measured" : goal.reached,
                   goal.met < 0 ? ""
                   : goal.met   ? "yes"
                                : "no"});
    return table.text();
}

std::string steps_table(const SpeedBench& bench) {
    std::vector<std::string> head = head_of(bench, "ms per step");
    head.push_back("n^");
    Table table(head);
    if (bench.sizes.empty()) return "";
    for (const StepRecord& kind : bench.sizes.front().steps) {
        std::vector<std::string> row{fmt::format("{}, {}", kind.name, threads_text(kind.threads))};
        std::vector<Measured> points;
        for (const SizeRecord& size : bench.sizes) {
            const StepRecord* s = size.step_of(kind.name, kind.threads);
            if (s) points.push_back({size.particles, s->seconds.median});
            std::string text = s ? milliseconds_text(s->seconds) : "–";
            if (s && s->substeps > 1) text += fmt::format(" ({:.0f} substeps)", s->substeps);
            row.push_back(text);
        }
        row.push_back(exponent(fit_power(points)));
        table.add(row);
    }
    return table.text();
}

std::string stages_table(const SpeedBench& bench) {
    std::string out;
    for (const int threads : {1, bench.threads}) {
        std::vector<std::string> head = head_of(bench, "ns per particle, " + threads_text(threads));
        head.push_back("n^");
        Table table(head);
        const auto add = [&](const char* name, double StageTimes::*slot) {
            std::vector<std::string> row{name};
            double all = 0;
            for (const SizeRecord& size : bench.sizes) {
                const StepRecord* s = size.step_of(own_step, threads);
                const double t = !s ? 0 : slot ? s->stages.*slot : s->seconds.median;
                all += t;
                row.push_back(s ? fmt::format("{:.3g}", 1e9 * t / size.particles) : "–");
            }
            row.push_back(exponent(step_law(bench, slot, threads)));
            if (all > 0) table.add(row);
        };
        for (const auto& [name, slot] : step_stages) add(name, slot);
        add("step", nullptr);
        out += table.text() + "\n";
        if (bench.threads == 1) break;
    }
    return out;
}

std::string solves_table(const SpeedBench& bench) {
    Table table(head_of(bench, "ms to 1e-3 (iterations)"));
    if (bench.sizes.empty()) return "";
    for (const SolveRecord& way : bench.sizes.front().solves) {
        std::vector<std::string> row{fmt::format("{}, {}", way.name, threads_text(way.threads))};
        for (const SizeRecord& size : bench.sizes) {
            const SolveRecord* s = size.solve_of(way.name, way.threads);
            std::string text = s ? milliseconds_text(s->seconds) : "–";
            if (s && s->iterations > 0) text += fmt::format(" ({:.0f})", s->iterations);
            row.push_back(text);
        }
        table.add(row);
    }
    return table.text();
}

std::string iterations_table(const SpeedBench& bench) {
    Table table(head_of(bench, "ns per row and iteration (GB/s; of the triad)"));
    if (bench.sizes.empty()) return "";
    for (const SolveRecord& way : bench.sizes.front().solves) {
        bool any = false;
        std::vector<std::string> row{fmt::format("{}, {}", way.name, threads_text(way.threads))};
        for (const SizeRecord& size : bench.sizes) {
            const SolveRecord* s = size.solve_of(way.name, way.threads);
            if (!s || !std::isfinite(s->row_iteration)) {
                row.push_back("–");
                continue;
            }
            any = true;
            std::string text = fmt::format("{:.3g}", 1e9 * s->row_iteration);
            if (std::isfinite(s->row_bytes)) {
                const double rate = 1e-9 * s->row_bytes / s->row_iteration;
                text += fmt::format(" ({:.1f}; {:.0f}%)", rate,
                                    100 * rate / bench.memory_triad[way.threads > 1 ? 1 : 0]);
            }
            row.push_back(text);
        }
        if (any) table.add(row);
    }
    return table.text();
}

std::string memory_table(const SpeedBench& bench) {
    Table table(head_of(bench, "bytes per particle"));
    std::vector<std::string> names;
    for (const SizeRecord& size : bench.sizes)
        for (const auto& [name, bytes] : size.memory.arrays)
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    // What is not named comes last.
    std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name != "rest"; });
    for (const std::string& name : names) {
        std::vector<std::string> row{name};
        for (const SizeRecord& size : bench.sizes) {
            const auto& arrays = size.memory.arrays;
            const auto found = std::find_if(arrays.begin(), arrays.end(),
                                            [&](const auto& array) { return array.first == name; });
            row.push_back(found == arrays.end() ? "–" : fmt::format("{:.0f}", found->second));
        }
        table.add(row);
    }
    std::vector<std::string> row{"in all, at its peak"};
    for (const SizeRecord& size : bench.sizes)
        row.push_back(std::isfinite(size.memory.peak) ? fmt::format("{:.0f}", size.memory.peak) : "–");
    table.add(row);
    return table.text();
}

std::string account_table(const SpeedBench& bench) {
    Table table(head_of(bench, "times faster than one thread"));
    const auto add = [&](std::string name, const auto& value) {
        std::vector<std::string> row{std::move(name)};
        for (const SizeRecord& size : bench.sizes)
            row.push_back(size.account.work() > 0 ? fmt::format("{:.2f}", value(size)) : "–");
        table.add(row);
    };
    add("tasks over components alone, any number",
        [](const SizeRecord& s) { return s.account.components_alone(); });
    for (const int threads : thread_counts(bench.threads)) {
        if (threads == 1) continue;
        add(fmt::format("{}, measured", threads_text(threads)), [&](const SizeRecord& s) {
            const StepRecord *one = s.step_of(own_step, 1), *many = s.step_of(own_step, threads);
            return one && many ? one->seconds.median / many->seconds.median : 0.0;
        });
    }
    for (const int threads : {2, 4, 8, 16, 32, 64})
        add(fmt::format("{}, foretold", threads_text(threads)),
            [&](const SizeRecord& s) { return s.account.speed_up(threads); });
    add("work over span: any number, foretold",
        [](const SizeRecord& s) { return s.account.span() > 0 ? s.account.work() / s.account.span() : 0.0; });
    return table.text();
}

std::string conditions(const SpeedBench& bench) {
    std::string text = fmt::format(
        "{}, {} ({}); triad {:.1f} GB/s on one thread, {:.1f} on all, {:.1f} and {:.1f} from the cache; "
        "{:.0f} s in all.\n",
        bench.scene, bench.processor, threads_text(bench.threads), bench.memory_triad[0],
        bench.memory_triad[1], bench.cache_triad[0], bench.cache_triad[1], bench.seconds);
    for (const SizeRecord& size : bench.sizes) {
        text += fmt::format(
            "{}: {} × {}, steps of {:.4g} ms from {:.2g} s on; {} components, the largest of {}; {} "
            "particles "
            "held; strain at most {:.2g}%, {:.2g}% for 99 in 100.\n",
            size_name(size.particles), size.grid[0], size.grid[1], 1e3 * size.step, size.start,
            size.components, size.largest, size.constrained, 100 * size.max_strain, 100 * size.p99_strain);
    }
    return text;
}

std::string left_out(const SpeedBench& bench) {
    std::string text;
    for (const SizeRecord& size : bench.sizes) {
        const auto add = [&](const auto& records) {
            for (const auto& r : records) {
                if (!r.left_out.empty())
                    text += fmt::format("Left out at {}: {}, {}: {}.\n", size_name(size.particles), r.name,
                                        threads_text(r.threads), r.left_out);
            }
        };
        add(size.steps);
        add(size.solves);
    }
    return text;
}

}  // namespace

std::string speed_summary(const SpeedBench& bench) {
    return goals_table(bench) + "\n" + steps_table(bench);
}

std::string speed_text(const SpeedBench& bench) {
    return conditions(bench) + "\nGoals\n\n" + goals_table(bench) +
           "\nA step by other ways: whole undecomposed; blocks, multigrid: all large components that way; "
           "plain: "
           "constrained-block CG on rows\n\n" +
           steps_table(bench) + "\nStages of the step\n\n" + stages_table(bench) +
           "A solve of the very same systems, set-up included, and for ours the assembly\n\n" +
           solves_table(bench) + "\nAn iteration\n\n" + iterations_table(bench) + "\nMemory\n\n" +
           memory_table(bench) + "\nMore threads\n\n" + account_table(bench) + "\n" + account_words + "\n" +
           (left_out(bench).empty() ? "" : "\n" + left_out(bench));
}

std::string size_name(double n) {
    if (n >= 9.5e5) return fmt::format("{:.3g}M", n / 1e6);
    return n >= 950 ? fmt::format("{:.3g}k", n / 1e3) : fmt::format("{:.0f}", n);
}

}  // namespace unravel::tool
