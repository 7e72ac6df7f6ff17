#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tool/base/exit.hpp"
#include "tool/picture/clip.hpp"
#include "tool/picture/picture_stamp.hpp"

namespace unravel::tool {

/// What the command line says about pictures and videos.
struct PictureOptions {
    std::string frames;          ///< --frames A-B
    int still = -1;              ///< this frame alone, without a video; −1: no
    double turntable = 0;        ///< s of one turn about a frame that stands still; 0: none
    std::string style = "both";  ///< views, separated by commas
    std::string size;            ///< --size WxH
    std::string camera;          ///< names of the scene's, separated by commas, or all; empty: its first
    std::string show;            ///< what wires' colours tell; empty: as the scene says
    bool legend = false, transparent = false;
    int motion_blur = 0, subdivide = -1;  ///< as the scene says
    std::string device = "auto";
    int samples = 0, supersample = 1;
    std::string video;  ///< mp4, webm, mkv, gif, none; empty: mp4, or mkv where frames have an alpha
    std::string codec, preset;
    int crf = -1;
    bool full_chroma = false;
    std::string quality = "standard";  ///< draft, standard, final
    std::string theme;                 ///< of the component view; empty: as the scene says
    std::string format = "png";        ///< of a still; svg, pdf: its component view as a figure
    bool pictures = true;
};

void add_frames(CLI::App& command, std::string& frames);
/// Of commands that draw at all: --size, --camera, --show, --device, --samples and --supersample.
void add_view_options(CLI::App& command, PictureOptions& o);
/// Of commands that make clips: those, and the frames', the look's and the video's.
void add_picture_options(CLI::App& command, PictureOptions& o);

/// The frames that --frames names, or all of the scene's where it names none. Throws UsageError.
FrameRange frames_of(const std::string& frames, const Scene& scene);

/// The clip that the options ask for; --size and what they say of the look are put into the scene. Throws
/// UsageError.
ClipOptions clip_options_of(const PictureOptions& options, Scene& scene);

}  // namespace unravel::tool
