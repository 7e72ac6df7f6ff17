#include "tool/render_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace unravel {

namespace {

// Two whole numbers with `separator` between them.
bool parse_pair(std::string_view text, char separator, int& a, int& b) {
    const std::size_t at = text.find(separator);
    if (at == text.npos) return false;
    const auto whole = [](std::string_view part, int& value) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        return error == std::errc() && end == part.data() + part.size();
    };
    return whole(text.substr(0, at), a) && whole(text.substr(at + 1), b);
}

}  // namespace

ClipOptions clip_options_of(const Options& options, Scene& scene) {
    ClipOptions clip;
    if (options.style == "textured") {
        clip.styles = {DrawStyle::textured};
    } else if (options.style == "components") {
        clip.styles = {DrawStyle::components};
    } else if (options.style != "both") {
        throw UsageError(fmt::format("--style {}: there is textured, components and both", options.style));
    }
    if (!options.size.empty() && !parse_pair(options.size, 'x', scene.clip.size[0], scene.clip.size[1])) {
        throw UsageError(fmt::format("--size {}: write it as 1920x1080", options.size));
    }
    if (!options.camera.empty()) {
        const auto found = std::ranges::find(scene.cameras, options.camera, &Camera::name);
        if (found == scene.cameras.end()) {
            std::string names;
            for (const Camera& camera : scene.cameras) names += (names.empty() ? "" : ", ") + camera.name;
            throw UsageError(fmt::format("--camera {}: the scene has {}", options.camera, names));
        }
        clip.camera = static_cast<std::size_t>(found - scene.cameras.begin());
    }
    clip.last = scene.clip.frames() - 1;
    if (!options.frames.empty()) {
        const bool pair = parse_pair(options.frames, '-', clip.first, clip.last);
        if (!pair || clip.first < 0 || clip.last < clip.first || clip.last >= scene.clip.frames()) {
            throw UsageError(fmt::format("--frames {}: write it as A-B within 0-{}", options.frames,
                                         scene.clip.frames() - 1));
        }
    }
    clip.device = parse_device_choice(options.device);
    clip.samples = options.samples;
    clip.supersample = options.supersample;
    clip.video_ending = options.video == "none" ? "" : "." + options.video;
    clip.codec = options.codec;
    clip.preset = options.preset;
    clip.crf = options.crf;
    clip.keep_pictures = options.pictures;
    return clip;
}

}  // namespace unravel
