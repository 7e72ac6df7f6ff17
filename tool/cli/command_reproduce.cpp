// unravel reproduce: every figure and figure-like claim of the paper again, on one page.

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/version.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"
#include "tool/report/html.hpp"
#include "tool/report/page_files.hpp"
#include "tool/report/preview.hpp"
#include "tool/study/reproduce/claims.hpp"

namespace unravel::tool {

namespace {

struct ReproduceOptions {
    bool quick = false;
    std::filesystem::path folder = "output/reproduce";
    std::string device = "auto";
    OutputOptions output;
};

constexpr int reproduced_width = 800;

std::string figure_html(const std::string& type, const std::vector<std::uint8_t>& bytes,
                        const std::string& caption) {
    return fmt::format(
        R"(<figure><img src="data:image/{};base64,{}" alt="{}"><figcaption>{}</figcaption></figure>)", type,
        base64(bytes), html_text(caption), html_text(caption));
}

std::string claim_html(const Claim& claim) {
    std::string html = fmt::format(
        "<section><h2>{}</h2>\n<div class=\"beside\"><div><h3>Paper</h3><p>{}</p></div>"
        "<div><h3>Here</h3><p>{}</p></div></div>\n",
        html_text(claim.heading), html_text(claim.paper), html_text(claim.ours));
    if (!claim.why.empty()) html += fmt::format("<p><b>Why they differ:</b> {}</p>\n", html_text(claim.why));
    html += "<div class=\"figures\">";
    for (const auto& [name, picture] : claim.views)
        html += figure_html("webp", encode_webp(shrink(picture, reproduced_width), 88), name);
    for (const Figure& figure : claim.figures)
        html += figure_html("svg+xml", {figure.svg.begin(), figure.svg.end()}, figure.caption);
    html += "</div>\n<p class=\"hint\">Again:</p><pre tabindex=\"0\">";
    for (const std::string& command : claim.commands) html += html_text(command) + "\n";
    return html + "</pre></section>\n";
}

std::string warnings_html(const std::vector<Claim>& claims, bool quick) {
    std::string html;
    if (quick)
        html +=
            "<li>Made with --quick: coarse, short, and timed once. Its numbers show that it works, no "
            "more.</li>";
    for (const Claim& claim : claims) {
        if (claim.ours.find("MISSING") != std::string::npos)
            html += fmt::format("<li>{}: {}</li>", html_text(claim.heading), html_text(claim.ours));
    }
    return html;
}

int reproduce(const ReproduceOptions& options) {
    const ReproduceScale scale{options.quick};
    const DeviceChoice device = parse_device_choice(options.device);
    const std::filesystem::path& folder = options.folder;
    std::filesystem::create_directories(folder);
    const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism, 2);

    std::vector<Claim> claims;
    const auto say = [&](const Claim& claim) {
        if (!options.output.talks()) return;
        fmt::print("{}\n  paper: {}\n  here:  {}\n", claim.heading, claim.paper, claim.ours);
        std::fflush(stdout);
    };
    for (Claim& claim : snapshot_claims(scale, device)) {
        say(claim);
        claims.push_back(std::move(claim));
    }
    for (const auto make : {sparsity_claim, imex_claim, preconditioner_claim, thread_claim}) {
        claims.push_back(make(scale));
        say(claims.back());
    }

    std::string body;
    nlohmann::ordered_json numbers{{"version", version()}, {"quick", scale.quick}};
    bool complete = true;
    for (const Claim& claim : claims) {
        body += claim_html(claim);
        numbers["claims"].push_back(
            {{"heading", claim.heading}, {"ours", claim.ours}, {"numbers", claim.numbers}});
        complete = complete && claim.ours.find("MISSING") == std::string::npos;
        for (const Figure& figure : claim.figures) {
            write_whole_file(folder / (figure.name + ".svg"), figure.svg);
            write_png(folder / (figure.name + ".png"), figure.image, {9, false});
        }
    }
    const std::string summary = fmt::format("Unravel {}; {} claims{}", version(), claims.size(),
                                            complete ? "" : ", some of them missing");
    const std::string warnings = warnings_html(claims, scale.quick);
    write_whole_file(folder / "report.html",
                     fill_page(page_file("reproduce.html"), {{"style", page_file("report.css")},
                                                             {"summary", summary},
                                                             {"warnings", warnings},
                                                             {"claims", body}}));
    write_whole_file(folder / "reproduce.json", numbers.dump(2) + "\n");
    if (options.output.json)
        fmt::print("{}\n", numbers.dump(2));
    else if (!options.output.quiet)
        fmt::print("  {}\n", (folder / "report.html").string());
    return exit_done;
}

}  // namespace

void add_reproduce(CommandLine& line) {
    const auto [command, o] =
        line.add("reproduce", "every figure and claim of the paper again, beside ours", reproduce);
    command.add_flag("--quick", o.quick, "small and short: shows that it works, not what it reaches");
    command.add_option("-o", o.folder, "folder of the report")->capture_default_str();
    add_device(command, o.device);
    add_output_options(command, o.output);
}

}  // namespace unravel::tool
