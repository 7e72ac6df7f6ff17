#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "sim/integrators/scheme.hpp"
#include "tool/study/accuracy/accuracy.hpp"

namespace unravel::tool {

namespace {

constexpr Integrator integrators[] = {Integrator::explicit_, Integrator::implicit, Integrator::adaptive_imex,
                                      Integrator::automatic, Integrator::bdf2,     Integrator::adaptive_imex2,
                                      Integrator::imex,      Integrator::newton};
constexpr const char* activations[] = {"start", "predicted", "resolve", "ahead"};
constexpr const char* bend_treatments[] = {"scheme", "explicit"};

const AccuracySetting common;

// Steps a frame: a factor of two apart, and `finer` times larger than the reference's at least.
std::vector<int> ladder(int coarsest, int finest, int reference, int finer = 8) {
    std::vector<int> steps;
    for (int k = coarsest; k <= std::min(finest, reference / finer); k *= 2) steps.push_back(k);
    return steps;
}

// Explicit steps are to come down to where they are stable, and cost so little that there may be many. They
// are of first order, so that the reference, of second, need not have more of them: the floor says where the
// two can't be told apart.
constexpr int coarsest_explicit = 8, finest_explicit = 2048;

void add(std::vector<AccuracySetting>& grid, AccuracySetting setting, const std::vector<int>& steps) {
    for (const int k : steps) {
        setting.steps_per_frame = k;
        if (std::find(grid.begin(), grid.end(), setting) == grid.end()) grid.push_back(setting);
    }
}

constexpr std::string_view header =
    "integrator,steps_per_frame,threshold,tolerance,activation,band,bend,broke,error,max_strain,lowest,"
    "energy,steps,rvm,"
    "median_seconds,fastest_seconds,slowest_seconds,runs,node,processor,seconds";

std::vector<std::string_view> split(std::string_view line, char at) {
    std::vector<std::string_view> parts;
    for (std::size_t end; (end = line.find(at)) != line.npos; line.remove_prefix(end + 1))
        parts.push_back(line.substr(0, end));
    parts.push_back(line);
    return parts;
}

template <typename T>
bool parse(std::string_view text, T& value) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

bool parse_point(const std::vector<std::string_view>& cells, AccuracyPoint& p) {
    if (cells.size() != split(header, ',').size()) return false;
    AccuracySetting& s = p.setting;
    const auto* scheme = std::find_if(std::begin(integrators), std::end(integrators),
                                      [&](Integrator i) { return cells[0] == integrator_name(i); });
    const auto* activation = std::find(std::begin(activations), std::end(activations), cells[4]);
    const auto* bend = std::find(std::begin(bend_treatments), std::end(bend_treatments), cells[6]);
    int broke = 0;
    if (scheme == std::end(integrators) || activation == std::end(activations) ||
        bend == std::end(bend_treatments))
        return false;
    s.integrator = *scheme;
    s.activation = static_cast<Activation>(activation - std::begin(activations));
    s.bend = static_cast<BendTreatment>(bend - std::begin(bend_treatments));
    bool good = parse(cells[1], s.steps_per_frame) && parse(cells[2], s.threshold) &&
                parse(cells[3], s.tolerance) && parse(cells[5], s.band) && parse(cells[7], broke) &&
                parse(cells[8], p.error) && parse(cells[9], p.max_strain) && parse(cells[10], p.lowest) &&
                parse(cells[11], p.energy) && parse(cells[12], p.steps) && parse(cells[13], p.rvm);
    p.broke = broke != 0;
    p.node = cells[cells.size() - 3];
    p.processor = cells[cells.size() - 2];
    for (const std::string_view text : split(cells.back(), ' ')) {
        p.seconds.push_back(0);
        good = good && parse(text, p.seconds.back());
    }
    return good;
}

}  // namespace

const char* integrator_name(Integrator integrator) {
    // `auto` has no scheme of its own.
    return integrator == Integrator::automatic ? "auto" : scheme_of(integrator).name;
}

std::string AccuracySetting::method() const {
    std::string text = integrator_name(integrator);
    if (threshold != common.threshold) text += fmt::format(", threshold {}", threshold);
    if (tolerance != common.tolerance) text += fmt::format(", tolerance {:.0e}", tolerance);
    if (activation != common.activation)
        text += fmt::format(", {} activation", activations[static_cast<int>(activation)]);
    if (band != common.band) text += fmt::format(", band {}", band);
    if (bend != common.bend) text += ", explicit bend";
    return text;
}

bool AccuracySetting::plain() const {
    return threshold == common.threshold && tolerance == common.tolerance &&
           activation == common.activation && band == common.band && bend == common.bend;
}

std::vector<AccuracySetting> accuracy_grid(const AccuracyReference& reference, const Scene& scene) {
    const int finest = reference.first.steps_per_frame;
    std::vector<AccuracySetting> grid{scene_setting(scene)};
    const auto variant = [](Integrator integrator, const auto& change) {
        AccuracySetting setting = common;
        setting.integrator = integrator;
        change(setting);
        return setting;
    };
    for (const Integrator integrator : integrators) {
        add(grid, variant(integrator, [](AccuracySetting&) {}),
            integrator == Integrator::explicit_
                ? ladder(coarsest_explicit, finest_explicit, finest_explicit, 1)
                : ladder(1, 64, finest));
    }
    const std::vector<int> few = ladder(2, 16, finest), wide = ladder(4, 64, finest);
    for (std::size_t k = 0; k < std::size(activations); ++k) {
        add(grid,
            variant(Integrator::adaptive_imex,
                    [k](AccuracySetting& s) {
                        s.activation = static_cast<Activation>(k);
                        // Without a band a cloth in balance, taut now and slack ahead by turns, is let go and
                        // caught.
                        if (s.activation == Activation::ahead) s.band = 0.02;
                    }),
            few);
    }
    for (const double band : {0.0, 0.02, 0.1})
        add(grid, variant(Integrator::adaptive_imex, [band](AccuracySetting& s) { s.band = band; }), few);
    add(grid, variant(Integrator::implicit, [](AccuracySetting& s) { s.bend = BendTreatment::explicit_; }),
        few);
    for (const Integrator adaptive : {Integrator::adaptive_imex, Integrator::adaptive_imex2}) {
        for (const double threshold : {0.05, 0.4})
            add(grid, variant(adaptive, [&](AccuracySetting& s) { s.threshold = threshold; }), wide);
        for (const double tolerance : {1e-1, 1e-2, 1e-5})
            add(grid, variant(adaptive, [&](AccuracySetting& s) { s.tolerance = tolerance; }), {4, 16});
    }
    return grid;
}

std::string accuracy_csv(const std::vector<AccuracyPoint>& points) {
    std::string csv = std::string(header) + "\n";
    for (const AccuracyPoint& p : points) {
        const AccuracySetting& s = p.setting;
        csv += fmt::format("{},{},{},{},{},{},{},{:d},{},{},{},{},{},{},{:.6f},{:.6f},{:.6f},{},{},{},",
                           integrator_name(s.integrator), s.steps_per_frame, s.threshold, s.tolerance,
                           activations[static_cast<int>(s.activation)], s.band,
                           bend_treatments[static_cast<int>(s.bend)], p.broke, p.error, p.max_strain,
                           p.lowest, p.energy, p.steps, p.rvm, p.median(), p.fastest(), p.slowest(),
                           p.seconds.size(), p.node, p.processor);
        for (std::size_t k = 0; k < p.seconds.size(); ++k)
            csv += fmt::format("{}{:.6f}", k ? " " : "", p.seconds[k]);
        csv += '\n';
    }
    return csv;
}

std::vector<AccuracyPoint> read_accuracy_csv(const std::string& csv) {
    std::vector<AccuracyPoint> points;
    const std::vector<std::string_view> lines = split(csv, '\n');
    if (lines.front() != header) return points;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        AccuracyPoint point;
        if (parse_point(split(lines[k], ','), point)) points.push_back(std::move(point));
    }
    return points;
}

}  // namespace unravel::tool
