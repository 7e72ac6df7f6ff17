#pragma once

// The table of encoders, and opening one of them. Used by VideoWriter and probe_encoders().

#include <string>
#include <vector>

#include "render/av.hpp"
#include "render/video.hpp"

namespace unravel::render::av {

/// A container, by the file's ending.
struct Container {
    const char* ending;  ///< ".mp4"
    const char* muxer;   ///< FFmpeg's name of it
    bool even = false;   ///< H.264 as players know it stores colour for blocks of 2 × 2
};

/// An encoder with what it needs to be told. Options are FFmpeg's own, "key=value:key=value".
struct EncoderEntry {
    const char* ending;
    const char* codec;
    AVPixelFormat pixels;
    const char* options;
    const char* quality_option = nullptr;  ///< what --crf sets; null: it has no such setting
    int quality = 0;                       ///< its default
    int best_quality = 0;                  ///< the ends of its scale
    int worst_quality = 0;
    const char* effort_option = nullptr;  ///< what --preset sets; null: none
    const char* effort = nullptr;         ///< its default
    const char* efforts = nullptr;        ///< all there are; null: FFmpeg itself checks
};

/// An encoder that opened.
struct OpenEncoder {
    Codec context;
    std::string description;
};

/// The container for this ending; throws VideoError with the endings there are.
const Container& container_for(const std::filesystem::path& file);

/// All entries for an ending, in the order in which they are tried.
std::vector<const EncoderEntry*> encoders_for(const Container& container);

/// Opens one encoder. Throws VideoError saying why it does not open, VideoSettingsError where the quality or
/// effort asked for is not one of its own.
OpenEncoder open_encoder(const EncoderEntry& entry, const VideoSettings& settings);

/// The one asked for, or the first that opens. Throws VideoError with those that do open, and
/// VideoSettingsError with the one reason why that encoder can't be set as asked.
OpenEncoder choose_encoder(const Container& container, const VideoSettings& settings);

}  // namespace unravel::render::av
