#include "tool/study/stability/stability_report.hpp"

#include <fmt/format.h>

#include "tool/report/html.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;
using Kind = HardOutcome::Kind;

const char* must_word(Must must) {
    constexpr const char* words[] = {"survive", "be refused", "be stopped"};
    return words[static_cast<int>(must)];
}

const char* kind_word(Kind kind) {
    constexpr const char* words[] = {"survived", "refused", "stopped"};
    return words[static_cast<int>(kind)];
}

std::string percent(double share) {
    return share < 0.0995 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

std::string energy_text(const HardLine& line) {
    if (line.hard.fed) return "fed";
    return line.outcome.energy_rise <= 0 ? "never grew" : fmt::format("+{:.1g}", line.outcome.energy_rise);
}

// What a reader wants to know of it: the numbers of a run, or the cause that was named.
std::string bound_text(const HardLine& line) {
    if (line.outcome.kind != Kind::survived) return line.outcome.says;
    return fmt::format("strain ≤ {}", percent(line.hard.strain));
}

}  // namespace

std::string verdict(const HardLine& line) {
    return line.outcome.failures.empty() ? kind_word(line.outcome.kind) : "FAILED";
}

std::string terminal_line(const HardLine& line) {
    const HardOutcome& o = line.outcome;
    std::string text = fmt::format("{:<22} {:<9}", line.hard.name, verdict(line));
    if (o.kind == Kind::survived) {
        text += fmt::format(
            " {:>5} particles {:>6} steps  strain {:>8}  energy {:<10}  depth {:.1g} m  CG ≤ {:<4} end "
            "{:.1e} m/s  {:016x}  {:.1f} s",
            o.particles, o.steps, percent(o.max_strain), energy_text(line), o.penetration, o.cg_most,
            o.final_speed, o.hash, o.seconds);
    } else {
        text += " " + o.says;
    }
    for (const std::string& failure : o.failures) text += "\n    " + failure;
    return text;
}

Json stability_json(const HardLine& line) {
    const HardOutcome& o = line.outcome;
    return {{"name", line.hard.name},
            {"what", line.hard.what},
            {"scene", line.hard.scene.filename().string()},
            {"set", line.hard.set},
            {"must", must_word(line.hard.must)},
            {"ended", kind_word(o.kind)},
            {"verdict", verdict(line)},
            {"failures", o.failures},
            {"says", o.says},
            {"particles", o.particles},
            {"steps", o.steps},
            {"max_strain", o.max_strain},
            {"strain_bound", line.hard.strain},
            {"energy_rise", o.energy_rise},
            {"energy_fed", line.hard.fed},
            {"steps_taken_again", o.again},
            {"flicker", o.flicker},
            {"chatter", o.chatter},
            {"jitter", o.jitter},
            {"penetration", o.penetration},
            {"pin_error", o.pin_error},
            {"final_speed", o.final_speed},
            {"cg_iterations_max", o.cg_most},
            {"unconverged_steps", o.unconverged},
            {"hash", fmt::format("{:016x}", o.hash)},
            {"same_bits_1_2_threads", o.same_bits},
            {"seconds", o.seconds},
            {"picture", line.picture}};
}

Json stability_json(const std::vector<HardLine>& lines) {
    Json json;
    json["cases"] = Json::array();
    for (const HardLine& line : lines) json["cases"].push_back(stability_json(line));
    return json;
}

std::string stability_markdown(const std::vector<HardLine>& lines) {
    std::string survive =
        "| must survive | largest strain (bound) | energy | deepest in a solid | CG iterations | fastest at "
        "the "
        "end | |\n|---|---|---|---|---|---|---|\n";
    std::string refuse = "| must be refused or stopped | | with the words |\n|---|---|---|\n";
    for (const HardLine& line : lines) {
        const HardOutcome& o = line.outcome;
        if (line.hard.must == Must::survive) {
            survive += fmt::format("| {} | {} (≤ {}) | {} | {} | ≤ {} | {:.1g} m/s | {} |\n", line.hard.what,
                                   percent(o.max_strain), percent(line.hard.strain), energy_text(line),
                                   o.penetration > 0 ? fmt::format("{:.1g} m", o.penetration) : "none inside",
                                   o.cg_most, o.final_speed, verdict(line));
        } else {
            refuse += fmt::format("| {} | {} | {} |\n", line.hard.what, verdict(line), o.says);
        }
    }
    return survive + "\n" + refuse;
}

std::string stability_html(const std::vector<HardLine>& lines, const std::vector<std::string>& maps) {
    std::string out =
        "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Hard cases</title>\n<style>\n"
        "body{font:15px/1.4 system-ui,sans-serif;margin:2em auto;max-width:1500px;padding:0 1em;"
        "color:#222;background:#f6f7f9}\n"
        "main{display:grid;grid-template-columns:repeat(auto-fill,minmax(20em,1fr));gap:1em}\n"
        "article{background:#fff;border-radius:6px;overflow:hidden;box-shadow:0 1px 3px #0003}\n"
        "article img,article .none{display:block;width:100%;aspect-ratio:16/9;background:#e4e7eb}\n"
        "article div.text{padding:.6em .9em}h2{font-size:1em;margin:0 0 .3em}\n"
        ".v{float:right;font-size:.85em;padding:.1em .5em;border-radius:4px;background:#dcefe0}\n"
        ".FAILED{background:#f3b4ab}.refused,.stopped{background:#e6e3f4}\n"
        "dl{display:grid;grid-template-columns:auto 1fr;gap:0 .8em;margin:.4em 0;font-size:.85em}"
        "dd{margin:0;text-align:right}\ncode{font-size:.8em;color:#666;overflow-wrap:anywhere}\n"
        "</style>\n<h1>Hard cases</h1>\n<main>\n";
    for (const HardLine& line : lines) {
        const HardOutcome& o = line.outcome;
        out += "<article>";
        out += line.picture.empty() ? std::string("<div class=\"none\"></div>")
                                    : fmt::format("<img src=\"{}\" alt=\"{}\" loading=\"lazy\">",
                                                  line.picture, html_text(line.hard.what));
        out += fmt::format("<div class=\"text\"><span class=\"v {0}\">{0}</span><h2>{1}</h2>", verdict(line),
                           html_text(line.hard.what));
        if (o.kind == Kind::survived) {
            out += fmt::format(
                "<dl><dt>particles, steps</dt><dd>{}, {}</dd><dt>largest strain</dt><dd>{} (≤ {})</dd>"
                "<dt>energy</dt><dd>{}</dd><dt>deepest in a solid</dt><dd>{:.1g} m</dd>"
                "<dt>CG iterations</dt><dd>≤ {}</dd><dt>fastest at the end</dt><dd>{:.1e} m/s</dd>"
                "<dt>taken again</dt><dd>{} steps</dd>"
                "<dt>flicker, chatter, jitter</dt><dd>{}, {}, {}</dd>"
                "<dt>1 and 2 threads</dt><dd>{} {:016x}</dd></dl>",
                o.particles, o.steps, percent(o.max_strain), percent(line.hard.strain), energy_text(line),
                o.penetration, o.cg_most, o.final_speed, o.again, percent(o.flicker), percent(o.chatter),
                percent(o.jitter), o.same_bits ? "same" : "DIFFERENT", o.hash);
        } else {
            out += fmt::format("<p>{}</p>", html_text(bound_text(line)));
        }
        for (const std::string& failure : o.failures)
            out += fmt::format("<p class=\"FAILED\">{}</p>", html_text(failure));
        std::string changed = line.hard.scene.filename().string();
        for (const std::string& set : line.hard.set) changed += " --set " + set;
        out += fmt::format("<code>{}</code></div></article>\n", html_text(changed));
    }
    out += "</main>\n";
    if (!maps.empty()) out += "<h1>Stiffness and step</h1>\n<main>\n";
    for (const std::string& map : maps)
        out += fmt::format("<article><object data=\"{}\" type=\"image/svg+xml\"></object></article>\n", map);
    return out + (maps.empty() ? "" : "</main>") + "</html>\n";
}

}  // namespace unravel::tool
