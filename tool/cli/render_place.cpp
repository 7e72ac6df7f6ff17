#include "tool/cli/render_place.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/hash.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/picture/picture_stamp.hpp"

namespace unravel::tool {

namespace {

// What the command line asks for, as a folder's name: "frames_2-3_80x60", "still_4_transparent".
std::string name_of_render(const PictureOptions& o, const std::vector<std::string>& overrides) {
    std::vector<std::string> parts;
    const auto add = [&](bool asked, std::string part) {
        if (asked) parts.push_back(std::move(part));
    };
    add(!o.frames.empty(), "frames_" + o.frames);
    add(o.still >= 0, fmt::format("still_{}", o.still));
    add(!o.size.empty(), o.size);
    add(!o.show.empty(), o.show);
    add(o.quality != "standard", o.quality);
    add(!o.theme.empty(), o.theme);
    add(o.full_chroma, "full_chroma");
    add(o.legend, "legend");
    add(o.transparent, "transparent");
    add(o.motion_blur > 0, fmt::format("motion_blur_{}", o.motion_blur));
    add(o.subdivide >= 0, fmt::format("subdivide_{}", o.subdivide));
    add(o.samples > 0, fmt::format("samples_{}", o.samples));
    add(o.supersample > 1, fmt::format("supersample_{}", o.supersample));
    if (!overrides.empty()) {
        const std::string all = fmt::format("{}", fmt::join(overrides, "\n"));
        parts.push_back(fmt::format("set_{:08x}", hash_bytes(all.data(), all.size()) >> 32));
    }
    return fmt::format("{}", fmt::join(parts, "_"));
}

}  // namespace

RunFolder place_of_render(const PictureOptions& options, const std::vector<std::string>& overrides,
                          const RunFolder& run, const Scene& scene, const ClipOptions& clip) {
    Scene plain = load_scene(run.scene());
    // A turn's pictures are not the clip's, and have names of their own.
    if (options.turntable > 0) {
        plain.clip.duration = scene.clip.duration;
        plain.cameras = scene.cameras;
    }
    const bool part = clip.first > 0 || clip.last < scene.clip.frames() - 1;
    if (!part && picture_stamp(plain, ClipOptions{}, "") == picture_stamp(scene, clip, "")) return run;
    const std::string name = name_of_render(options, overrides);
    return name.empty() ? run : RunFolder{run.root / "renders" / name};
}

}  // namespace unravel::tool
