// unravel doctor: every route to a renderer and every encoder, tried for real.

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "render/gl_context.hpp"
#include "render/video.hpp"
#include "tool/base/exit.hpp"
#include "tool/cli/commands.hpp"
#include "tool/cli/common_options.hpp"

namespace unravel::tool {

namespace {

constexpr const char* install_encoders =
    "apt-get install --reinstall libavcodec59 libavformat59 libx264-164 libvpx7 (Debian 12; each encoder is "
    "a library "
    "of its own), or choose another --video";

bool any_opens(const std::vector<EncoderVerdict>& encoders, const std::string& ending) {
    return std::any_of(encoders.begin(), encoders.end(),
                       [&](const auto& e) { return e.opens && e.ending == ending; });
}

int doctor(const OutputOptions& options) {
    const std::vector<RendererAttempt> routes = probe_renderers();
    const std::vector<EncoderVerdict> encoders = probe_encoders();
    const bool draws = std::any_of(routes.begin(), routes.end(), [](const auto& r) { return r.usable; });
    const bool encodes = any_opens(encoders, ".mp4");
    if (options.json) {
        nlohmann::ordered_json json{{"draws", draws}, {"encodes", encodes}};
        for (const RendererAttempt& r : routes) {
            json["renderers"].push_back({{"route", r.route},
                                         {"usable", r.usable},
                                         {"software", r.software},
                                         {"renderer", r.renderer},
                                         {"reason", r.reason},
                                         {"fix", r.fix}});
        }
        for (const EncoderVerdict& e : encoders) {
            json["encoders"].push_back(
                {{"ending", e.ending}, {"codec", e.codec}, {"opens", e.opens}, {"reason", e.reason}});
        }
        fmt::print("{}\n", json.dump(2));
    } else {
        fmt::print("renderers\n");
        for (const RendererAttempt& r : routes) {
            fmt::print("  {} {}: {}\n", r.usable ? "yes" : "no ", r.route, r.usable ? r.renderer : r.reason);
            if (!r.fix.empty()) fmt::print("      try: {}\n", r.fix);
        }
        fmt::print("encoders\n");
        for (const EncoderVerdict& e : encoders) {
            fmt::print("  {} {:<6} {}{}{}\n", e.opens ? "yes" : "no ", e.ending, e.codec, e.opens ? "" : ": ",
                       e.reason);
        }
        for (const char* ending : {".mp4", ".webm", ".mkv", ".gif"}) {
            if (!any_opens(encoders, ending))
                fmt::print("  nothing makes {}\n      try: {}\n", ending, install_encoders);
        }
        fmt::print("{}\n",
                   draws && encodes ? "all that is needed is here" : "something is missing, see above");
    }
    return draws && encodes ? exit_done : exit_no_renderer;
}

}  // namespace

void add_doctor(CommandLine& line) {
    const auto [command, o] = line.add(
        "doctor", "which renderers and encoders this machine has, and how to get what is missing", doctor);
    add_output_options(command, o);
}

}  // namespace unravel::tool
