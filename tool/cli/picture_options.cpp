#include "tool/cli/picture_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "sim/scene/enums.hpp"
#include "tool/cli/common_options.hpp"

namespace unravel::tool {

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

// What the command line says about looks goes before what the scene says.
void apply_look(const PictureOptions& options, Look& look) {
    if (!options.show.empty())
        look.show = static_cast<Show>(std::ranges::find(show_words, options.show) - std::begin(show_words));
    if (!options.theme.empty())
        look.theme =
            static_cast<Theme>(std::ranges::find(theme_words, options.theme) - std::begin(theme_words));
    look.legend = look.legend || options.legend;
    look.transparent = look.transparent || options.transparent;
    if (options.motion_blur > 0) look.motion_blur = options.motion_blur;
    if (options.subdivide >= 0) look.subdivide = options.subdivide;
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> parts(1);
    for (const char c : list)
        if (c == ',')
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

std::vector<Layout> layouts_of(const std::string& style) {
    std::vector<Layout> layouts;
    for (const std::string& part : split(style)) {
        if (part == "both") {
            layouts.insert(layouts.end(), {Layout::textured, Layout::components});
            continue;
        }
        const auto is_named = [&](Layout layout) {
            std::string name = layout_name(layout);
            std::ranges::replace(name, '_', '-');
            return name == part;
        };
        const auto* const found = std::ranges::find_if(all_layouts, is_named);
        if (found == std::end(all_layouts))
            throw UsageError(fmt::format(
                "--style {}: there is textured, components, both, overlay and side-by-side", part));
        layouts.push_back(*found);
    }
    return layouts;
}

std::vector<std::size_t> cameras_of(const std::string& names, const Scene& scene) {
    std::vector<std::size_t> cameras;
    if (names.empty()) return {0};
    if (names == "all") {
        for (std::size_t k = 0; k < scene.cameras.size(); ++k) cameras.push_back(k);
        return cameras;
    }
    for (const std::string& name : split(names)) {
        const auto found = std::ranges::find(scene.cameras, name, &Camera::name);
        if (found == scene.cameras.end()) {
            std::string there;
            for (const Camera& camera : scene.cameras) there += (there.empty() ? "" : ", ") + camera.name;
            throw UsageError(fmt::format("--camera {}: the scene has {}", name, there));
        }
        cameras.push_back(static_cast<std::size_t>(found - scene.cameras.begin()));
    }
    return cameras;
}

void set_frames(const PictureOptions& options, const Scene& scene, ClipOptions& clip) {
    const FrameRange range = frames_of(options.frames, scene);
    clip.first = range.first;
    clip.last = range.last;
    if (options.still < 0) return;
    const int last = scene.clip.frames() - 1;
    if (options.still > last || !options.frames.empty())
        throw UsageError(fmt::format("--still {}: one frame of 0-{}, without --frames", options.still, last));
    clip.first = clip.last = options.still;
}

}  // namespace

void add_frames(CLI::App& command, std::string& frames) {
    command.add_option("--frames", frames, "A-B: only these frames");
}

void add_view_options(CLI::App& command, PictureOptions& o) {
    command.add_option("--size", o.size, "WxH, both even for an mp4 (default: the scene's)");
    command.add_option("--camera", o.camera,
                       "the scene's cameras by name, with commas between, or all (default: the first)");
    command.add_option("--show", o.show, "what the colours of the component view tell (default: components)")
        ->check(CLI::IsMember(std::vector<std::string>(std::begin(show_words), std::end(show_words))));
    add_device(command, o.device);
    command
        .add_option("--samples", o.samples,
                    "per pixel, clamped to what the renderer offers (default: 4; on the CPU outlines are "
                    "smoothed instead)")
        ->check(CLI::Range(1, 64));
    command.add_option("--supersample", o.supersample, "draw this many times larger and average")
        ->check(CLI::Range(1, 4));
    command
        .add_option(
            "--quality", o.quality,
            "of textured pictures: draft to find camera and motion, standard, or final: the mean of 32 "
            "pictures, with depth of field and motion blur")
        ->check(CLI::IsMember({"draft", "standard", "final"}))
        ->capture_default_str();
    command
        .add_option("--theme", o.theme,
                    "the component view on a screen's dark ground, or as a figure on paper (default: dark)")
        ->check(CLI::IsMember({"dark", "paper"}));
}

void add_picture_options(CLI::App& command, PictureOptions& o) {
    add_frames(command, o.frames);
    command
        .add_option("--style", o.style,
                    "textured, components, both, overlay or side-by-side; several with commas between")
        ->capture_default_str();
    add_view_options(command, o);
    command.add_flag("--legend", o.legend, "tell in the component view what its colours mean");
    command.add_flag("--transparent", o.transparent,
                     "no ground, no background: frames with an alpha channel");
    command.add_option("--motion-blur", o.motion_blur, "sub-frames that each picture is the mean of")
        ->check(CLI::Range(1, 64));
    command
        .add_option("--subdivide", o.subdivide, "draw each cell as 4 to the power of this many smooth ones")
        ->check(CLI::Range(0, 3));
    command
        .add_option("--video", o.video,
                    "mp4, webm, mkv (lossless), gif or none (default: mp4; mkv where --transparent)")
        ->check(CLI::IsMember({"mp4", "webm", "mkv", "gif", "none"}));
    command.add_option("--codec", o.codec, "this encoder and no other");
    command.add_option("--crf", o.crf, "quality of the video, smaller is better")
        ->check(CLI::NonNegativeNumber);
    command.add_option("--preset", o.preset, "the encoder's effort");
    command.add_flag("--full-chroma", o.full_chroma,
                     "colour for every pixel of an mp4 or webm (4:4:4), which not every player shows");
    command.add_flag("--pictures,!--no-pictures", o.pictures, "write PNG frames (default: yes)");
}

FrameRange frames_of(const std::string& frames, const Scene& scene) {
    FrameRange range{0, scene.clip.frames() - 1};
    const int last = range.last;
    if (frames.empty()) return range;
    const bool pair = parse_pair(frames, '-', range.first, range.last);
    if (!pair || range.first < 0 || range.last < range.first || range.last > last)
        throw UsageError(fmt::format("--frames {}: write it as A-B within 0-{}", frames, last));
    return range;
}

ClipOptions clip_options_of(const PictureOptions& options, Scene& scene) {
    ClipOptions clip;
    apply_look(options, scene.look);
    if (scene.look.transparent && scene.look.theme == Theme::paper)
        throw UsageError("a page is white all over: --theme paper does not go with --transparent");
    if (options.format != "png") clip.format = options.format;
    const bool figure = !clip.format.empty();
    if (figure && (options.still < 0 || options.turntable > 0))
        throw UsageError(fmt::format("--format {}: a figure is of one frame; add --still", options.format));
    if (figure && options.style != "both" && options.style != "components")
        throw UsageError(fmt::format("--format {}: figures are of the component view", options.format));
    if (!options.size.empty() && !parse_pair(options.size, 'x', scene.clip.size[0], scene.clip.size[1]))
        throw UsageError(fmt::format("--size {}: write it as 1920x1080", options.size));
    clip.views.clear();
    for (const std::size_t camera : cameras_of(options.camera, scene)) {
        for (const Layout layout : layouts_of(figure ? "components" : options.style)) {
            const ClipView view = make_view(scene, layout, camera);
            if (std::ranges::find(clip.views, view.name, &ClipView::name) != clip.views.end())
                throw UsageError(fmt::format("--style, --camera: two views would be named {}", view.name));
            clip.views.push_back(view);
        }
    }
    set_frames(options, scene, clip);
    clip.device = parse_device_choice(options.device);
    clip.samples = options.samples;
    clip.supersample = options.supersample;
    clip.quality = options.quality == "draft"   ? Quality::draft
                   : options.quality == "final" ? Quality::final_
                                                : Quality::standard;
    const bool still = options.still >= 0 && options.turntable == 0;
    const std::string usual = still ? "none" : scene.look.transparent ? "mkv" : "mp4";
    const std::string video = options.video.empty() ? usual : options.video;
    clip.video_ending = video == "none" ? "" : "." + video;
    clip.codec = options.codec;
    clip.preset = options.preset;
    clip.crf = options.crf;
    clip.full_chroma = options.full_chroma;
    clip.keep_pictures = options.pictures;
    return clip;
}

}  // namespace unravel::tool
