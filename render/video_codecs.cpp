#include "render/video_codecs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace unravel::render::av {
namespace {

constexpr std::array containers{
    Container{".mp4", "mp4"},
    Container{".webm", "webm"},
    Container{".mkv", "matroska"},
    Container{".gif", "gif"},
};

constexpr const char* x264_presets =
    "ultrafast superfast veryfast faster fast medium slow slower veryslow placebo";

// Quality 18 of x264 can't be told from the frames by eye; the others are set to look like it. VP9's "good"
// effort costs five times its "realtime" one and more than the frames themselves. The bit rates are for
// encoders that know no constant quality.
constexpr std::array encoders{
    EncoderEntry{".mp4", "libx264", AV_PIX_FMT_YUV420P, "", "crf", 18, 51, "preset", "veryfast",
                 x264_presets},
    EncoderEntry{".mp4", "libopenh264", AV_PIX_FMT_YUV420P, "b=20M"},
    EncoderEntry{".mp4", "h264_nvenc", AV_PIX_FMT_YUV420P, "rc=vbr:b=0", "cq", 20, 51, "preset", "p4"},
    EncoderEntry{".mp4", "h264_qsv", AV_PIX_FMT_NV12, "flags=+qscale", "global_quality", 20, 51, "preset",
                 "medium"},
    EncoderEntry{".mp4", "h264_v4l2m2m", AV_PIX_FMT_YUV420P, "b=20M"},
    EncoderEntry{".mp4", "mpeg4", AV_PIX_FMT_YUV420P, "flags=+qscale", "global_quality", 2, 31},
    EncoderEntry{".webm", "libvpx-vp9", AV_PIX_FMT_YUV420P, "b=0:row-mt=1:deadline=realtime", "crf", 24, 63,
                 "cpu-used", "5"},
    EncoderEntry{".webm", "libvpx", AV_PIX_FMT_YUV420P, "b=40M:deadline=realtime", "crf", 8, 63, "cpu-used",
                 "5"},
    EncoderEntry{".webm", "libaom-av1", AV_PIX_FMT_YUV420P, "b=0:row-mt=1:usage=realtime", "crf", 24, 63,
                 "cpu-used", "8"},
    EncoderEntry{".mkv", "ffv1", AV_PIX_FMT_0RGB32, "level=3:slicecrc=1:slices=4"},
    EncoderEntry{".mkv", "libx264rgb", AV_PIX_FMT_BGR0, "qp=0", nullptr, 0, 0, "preset", "ultrafast",
                 x264_presets},
    EncoderEntry{".gif", "gif", AV_PIX_FMT_PAL8, ""},
};

struct Options {
    AVDictionary* entries = nullptr;
    Options() = default;
    ~Options() { av_dict_free(&entries); }
    Options(const Options&) = delete;
    Options& operator=(const Options&) = delete;
    void set(const char* key, const std::string& value) { av_dict_set(&entries, key, value.c_str(), 0); }
};

void set_colours(AVCodecContext& context) {
    const bool yuv = context.pix_fmt == AV_PIX_FMT_YUV420P || context.pix_fmt == AV_PIX_FMT_NV12;
    context.color_primaries = AVCOL_PRI_BT709;
    context.color_trc = yuv ? AVCOL_TRC_BT709 : AVCOL_TRC_IEC61966_2_1;
    context.colorspace = yuv ? AVCOL_SPC_BT709 : AVCOL_SPC_RGB;
    context.color_range = yuv ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG;
    if (yuv) context.chroma_sample_location = AVCHROMA_LOC_LEFT;
}

bool has_word(std::string_view words, std::string_view word) {
    return fmt::format(" {} ", words).find(fmt::format(" {} ", word)) != std::string::npos;
}

std::string describe(const EncoderEntry& entry, const std::string& quality, int threads) {
    const std::string_view ending = entry.ending;
    const char* colours = ending == ".mkv"   ? "lossless RGB"
                          : ending == ".gif" ? "256 colours a frame"
                                             : "yuv420p, BT.709";
    return fmt::format("{} ({}{}, {} threads)", entry.codec, colours, quality, threads);
}

// Quality and effort as the user or else our table has them, and how they are told to the user.
std::string set_quality(const EncoderEntry& entry, const VideoSettings& settings, AVCodecContext& context,
                        Options& options) {
    std::string told;
    if (settings.crf >= 0 && !entry.quality_option)
        throw VideoError(fmt::format("the encoder {} has no quality setting: leave out --crf", entry.codec));
    if (!settings.preset.empty() && !entry.effort_option)
        throw VideoError(fmt::format("the encoder {} has no presets: leave out --preset", entry.codec));
    if (settings.crf > entry.worst_quality)
        throw VideoError(fmt::format("--crf {} is beyond the {} that {} knows", settings.crf,
                                     entry.worst_quality, entry.codec));
    if (entry.efforts && !settings.preset.empty() && !has_word(entry.efforts, settings.preset))
        throw VideoError(
            fmt::format("{} has no preset '{}'; it has: {}", entry.codec, settings.preset, entry.efforts));
    if (entry.quality_option) {
        const int quality = settings.crf >= 0 ? settings.crf : entry.quality;
        // FFmpeg counts this one option in steps of 1/118 of a quantiser.
        if (std::string_view(entry.quality_option) == "global_quality")
            context.global_quality = quality * FF_QP2LAMBDA;
        else
            options.set(entry.quality_option, std::to_string(quality));
        told += fmt::format(", crf {}", quality);
    }
    if (entry.effort_option) {
        const std::string effort = settings.preset.empty() ? entry.effort : settings.preset;
        options.set(entry.effort_option, effort);
        told += fmt::format(", preset {}", effort);
    }
    return told;
}

}  // namespace

const Container& container_for(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    for (const Container& container : containers)
        if (ending == container.ending) return container;
    throw VideoSettingsError(
        fmt::format("{}: a video's name ends in .mp4, .webm, .mkv or .gif", file.string()));
}

std::vector<const EncoderEntry*> encoders_for(const Container& container) {
    std::vector<const EncoderEntry*> found;
    for (const EncoderEntry& entry : encoders)
        if (std::string_view(entry.ending) == container.ending) found.push_back(&entry);
    return found;
}

OpenEncoder open_encoder(const EncoderEntry& entry, const VideoSettings& settings) {
    const AVCodec* codec = avcodec_find_encoder_by_name(entry.codec);
    if (!codec) throw VideoError("this FFmpeg was built without it");
    if (settings.alpha && entry.pixels != AV_PIX_FMT_0RGB32) throw VideoError("it keeps no transparency");
    auto context = made<Codec>(avcodec_alloc_context3(codec));
    context->width = settings.width;
    context->height = settings.height;
    context->pix_fmt = settings.alpha ? AV_PIX_FMT_RGB32 : entry.pixels;
    context->time_base = {settings.fps_den, settings.fps_num};
    context->framerate = {settings.fps_num, settings.fps_den};
    context->sample_aspect_ratio = {1, 1};
    context->thread_count = settings.threads;
    // Repeatable arithmetic, and no version of FFmpeg in the stream.
    context->flags |= AV_CODEC_FLAG_BITEXACT;
    if (std::string_view(entry.ending) != ".gif") context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_colours(*context);

    const LogCapture log;
    Options options;
    av_dict_parse_string(&options.entries, entry.options, "=", ":", 0);
    const std::string quality = set_quality(entry, settings, *context, options);
    if (const int error = avcodec_open2(context.get(), codec, &options.entries); error < 0)
        throw VideoError(log.explain(error));
    if (const auto* unknown = av_dict_get(options.entries, "", nullptr, AV_DICT_IGNORE_SUFFIX))
        throw VideoError(fmt::format("it does not know the setting {}", unknown->key));
    return {std::move(context), describe(entry, quality, settings.threads)};
}

namespace {

// Empty, with the reason added to `failures`, where the encoder does not open.
std::optional<OpenEncoder> try_encoder(const EncoderEntry& entry, const VideoSettings& settings,
                                       std::string& failures) {
    try {
        return open_encoder(entry, settings);
    } catch (const VideoError& error) {
        failures += fmt::format("{}{}: {}", failures.empty() ? "" : "; ", entry.codec, error.what());
        return {};
    }
}

std::string encoders_that_open(const Container& container, VideoSettings settings) {
    settings.crf = -1;
    settings.preset.clear();
    std::string names, failures;
    for (const EncoderEntry* entry : encoders_for(container))
        if (try_encoder(*entry, settings, failures))
            names += fmt::format("{}{}", names.empty() ? "" : ", ", entry->codec);
    return names.empty() ? "none" : names;
}

}  // namespace

OpenEncoder choose_encoder(const Container& container, const VideoSettings& settings) {
    std::string failures;
    for (const EncoderEntry* entry : encoders_for(container)) {
        if (!settings.codec.empty() && settings.codec != entry->codec) continue;
        if (std::optional<OpenEncoder> opened = try_encoder(*entry, settings, failures)) {
            if (!failures.empty()) opened->description += fmt::format(", since {}", failures);
            return std::move(*opened);
        }
    }
    if (failures.empty())
        failures = fmt::format("{}: it is not one of the encoders for that", settings.codec);
    throw VideoError(fmt::format("can't make {} with {}; encoders that open here: {}", container.ending,
                                 failures, encoders_that_open(container, settings)));
}

}  // namespace unravel::render::av

namespace unravel::render {

std::vector<EncoderVerdict> probe_encoders() {
    VideoSettings settings;
    settings.width = 640;
    settings.height = 360;
    std::vector<EncoderVerdict> verdicts;
    for (const av::EncoderEntry& entry : av::encoders) {
        EncoderVerdict verdict{entry.ending, entry.codec, true, ""};
        try {
            av::open_encoder(entry, settings);
        } catch (const VideoError& error) {
            verdict.opens = false;
            verdict.reason = error.what();
        }
        verdicts.push_back(verdict);
    }
    return verdicts;
}

}  // namespace unravel::render
