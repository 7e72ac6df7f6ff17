#include "tool/inspect/page.hpp"

#include <fmt/format.h>

#include "render/png.hpp"
#include "tool/report/html.hpp"
#include "tool/report/page_files.hpp"
#include "tool/report/preview.hpp"

namespace unravel::tool {

namespace {

constexpr std::size_t most_rows = 500;
constexpr int inspected_width = 960;

std::string figure_html(const std::string& type, const std::vector<std::uint8_t>& bytes,
                        const std::string& caption, const std::string& alt) {
    return fmt::format(
        R"(<figure><img src="data:image/{};base64,{}" alt="{}"><figcaption>{}</figcaption></figure>)", type,
        base64(bytes), html_text(alt), html_text(caption));
}

std::string figure_html(const Figure& figure) {
    if (figure.dots_only)
        return figure_html("svg+xml", {figure.svg.begin(), figure.svg.end()}, figure.caption, figure.caption);
    return figure_html("png", encode_png(figure.image, {9, false}), figure.caption, figure.caption);
}

std::string fact(const char* name, const std::string& value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
}

std::string facts_html(const InspectedStep& step) {
    const StepReport& r = step.report;
    return fact("components", std::to_string(r.components)) + fact("largest", std::to_string(r.largest)) +
           fact("fully constrained", std::to_string(r.constrained)) +
           fact("partly constrained", std::to_string(r.partly)) +
           fact("implicit springs", std::to_string(r.implicit)) +
           fact("explicit springs", std::to_string(r.explicit_)) +
           fact("inactive springs", std::to_string(r.inactive)) +
           fact("contacts", std::to_string(r.contacts)) +
           fact("CG iterations", std::to_string(r.cg_iterations)) + fact("RVMs", std::to_string(r.rvm)) +
           fact("greatest strain", fmt::format("{:.3g}%", 100 * r.max_strain));
}

std::string solver_words(const ComponentSolve& solve) {
    return html_text(fmt::format("{}: {}", words(solve.by), words(solve.because)));
}

std::string components_html(const InspectedStep& step) {
    std::string html;
    for (std::size_t k = 0; k < std::min(step.components.size(), most_rows); ++k) {
        const ComponentRow& row = step.components[k];
        html += fmt::format(
            "<tr><td><span class=\"swatch\" style=\"background:#{:02x}{:02x}{:02x}\"></span></td>"
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2e}</td><td "
            "class=\"words\">{}</td></tr>\n",
            row.color.r, row.color.g, row.color.b, row.id, row.particles, row.boundary, row.springs,
            row.solve.iterations, row.solve.rvm, row.solve.residual, solver_words(row.solve));
    }
    if (step.components.size() > most_rows)
        html += fmt::format(
            "<tr class=\"rest\"><td colspan=\"9\">and {} smaller ones; --json lists all</td></tr>",
            step.components.size() - most_rows);
    return html;
}

}  // namespace

std::string inspect_page(const InspectedStep& step, const std::string& scene_name,
                         const std::vector<Image>& views, const std::string& no_views,
                         const std::vector<Figure>& figures,
                         const std::vector<std::pair<std::string, nlohmann::ordered_json>>& asked) {
    const char* const names[] = {"textured view", "components view"};
    std::string views_html = views.empty() ? html_text("No views: " + no_views) : "", asked_html, matrices,
                histograms;
    for (std::size_t k = 0; k < views.size(); ++k)
        views_html +=
            figure_html("webp", encode_webp(shrink(views[k], inspected_width), 90), names[k], names[k]);
    for (const auto& [heading, numbers] : asked) {
        asked_html += fmt::format("<h2>{}</h2><pre tabindex=\"0\">{}</pre>", html_text(heading),
                                  html_text(numbers.dump(2)));
    }
    for (const Figure& figure : figures)
        (figure.name.starts_with("matrix") ? matrices : histograms) += figure_html(figure);
    const std::string title =
        html_text(fmt::format("{}: frame {}, step {} of {}", scene_name, step.frame, step.step, step.steps));
    const std::string summary =
        fmt::format("step {} of the run, t = {:.6g} s, h = {:.6g} s, {} particles", step.report.step,
                    step.report.t, step.report.h, step.record.component.size());
    const std::string facts = facts_html(step), components = components_html(step);
    return fill_page(page_file("inspect.html"), {{"title", title},
                                                 {"style", page_file("report.css")},
                                                 {"summary", summary},
                                                 {"views", views_html},
                                                 {"facts", facts},
                                                 {"asked", asked_html},
                                                 {"matrices", matrices},
                                                 {"histograms", histograms},
                                                 {"components", components}});
}

}  // namespace unravel::tool
