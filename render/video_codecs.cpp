#include "render/video_codecs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <optional>

namespace unravel::render::av {
namespace {

constexpr std::array containers{
    Container{".mp4", "mp4", true},
    Container{".webm", "webm"},
    Container{".mkv", "matroska"},
    Container{".gif", "gif"},
};

constexpr const char* x264_presets =
    "ultrafast superfast veryfast faster fast medium slow slower veryslow placebo";

// Quality 18 of x264 can't be told from the frames by eye; the others are set to look like it. VP9's "good"
// effort costs five times its "realtime" one and more than the frames themselves. The bit rates are for
// encoders that know no constant quality. Quality 0 is left out where it means something else: lossless, in a
// profile that few players know (x264), or the encoder's own choice.
constexpr std::array encoders{
    EncoderEntry{".mp4", "libx264", AV_PIX_FMT_YUV420P, "", "crf", 18, 1, 51, "preset", "veryfast",
                 x264_presets},
    EncoderEntry{".mp4", "libopenh264", AV_PIX_FMT_YUV420P, "b=20M"},
    EncoderEntry{".mp4", "h264_nvenc", AV_PIX_FMT_YUV420P, "rc=vbr:b=0", "cq", 20, 1, 51, "preset", "p4",
                 "p1 p2 p3 p4 p5 p6 p7"},
    EncoderEntry{".mp4", "h264_qsv", AV_PIX_FMT_NV12, "flags=+qscale", "global_quality", 20, 1, 51, "preset",
                 "medium", "veryfast faster fast medium slow slower veryslow"},
    EncoderEntry{".mp4", "h264_v4l2m2m", AV_PIX_FMT_YUV420P, "b=20M"},
    EncoderEntry{".mp4", "mpeg4", AV_PIX_FMT_YUV420P, "flags=+qscale", "global_quality", 2, 1, 31},
    EncoderEntry{".webm", "libvpx-vp9", AV_PIX_FMT_YUV420P, "b=0:row-mt=1:deadline=realtime", "crf", 24, 0,
                 63, "cpu-used", "5", "0 to 9"},
    EncoderEntry{".webm", "libvpx", AV_PIX_FMT_YUV420P, "b=40M:deadline=realtime", "crf", 8, 4, 63,
                 "cpu-used", "5", "0 to 15"},
    EncoderEntry{".webm", "libaom-av1", AV_PIX_FMT_YUV420P, "b=0:row-mt=1:usage=realtime", "crf", 24, 0, 63,
                 "cpu-used", "8", "0 to 8"},
    EncoderEntry{".mkv", "ffv1", AV_PIX_FMT_0RGB32, "level=3:slicecrc=1:slices=4"},
    EncoderEntry{".mkv", "libx264rgb", AV_PIX_FMT_BGR0, "qp=0", nullptr, 0, 0, 0, "preset", "ultrafast",
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

// At least one frame in each second can be jumped to; where an encoder has its own mind, no less often.
void set_keyframes(AVCodecContext& context, const VideoSettings& settings) {
    const int second = std::max(1, settings.fps_num / settings.fps_den);
    context.gop_size = context.gop_size > 0 ? std::min(context.gop_size, second) : second;
}

// x264's AVX-512 kernels of the macroblock tree work on 16 blocks at a time and let those beyond the end of a
// row take part: memory that nobody has written, or of another row. The same frames then give other bits from
// time to time (seen with build 164 where a row's blocks are no multiple of 16), and other bits than on
// processors without AVX-512.
bool has_avx512() {
#ifdef __x86_64__
    return __builtin_cpu_supports("avx512f") != 0;
#else
    return false;
#endif
}

void set_colours(AVCodecContext& context) {
    const bool yuv = context.pix_fmt == AV_PIX_FMT_YUV420P || context.pix_fmt == AV_PIX_FMT_YUV444P ||
                     context.pix_fmt == AV_PIX_FMT_NV12;
    context.color_primaries = AVCOL_PRI_BT709;
    context.color_trc = yuv ? AVCOL_TRC_BT709 : AVCOL_TRC_IEC61966_2_1;
    context.colorspace = yuv ? AVCOL_SPC_BT709 : AVCOL_SPC_RGB;
    context.color_range = yuv ? AVCOL_RANGE_MPEG : AVCOL_RANGE_JPEG;
    if (yuv && context.pix_fmt != AV_PIX_FMT_YUV444P) context.chroma_sample_location = AVCHROMA_LOC_LEFT;
}

bool has_word(std::string_view words, std::string_view word) {
    return fmt::format(" {} ", words).find(fmt::format(" {} ", word)) != std::string::npos;
}

// A list of names, or a range of whole numbers as "0 to 9".
bool knows_effort(const EncoderEntry& entry, const std::string& effort) {
    int first = 0, last = 0, asked = 0;
    if (std::sscanf(entry.efforts, "%d to %d", &first, &last) != 2) return has_word(entry.efforts, effort);
    const auto [end, error] = std::from_chars(effort.data(), effort.data() + effort.size(), asked);
    return error == std::errc() && end == effort.data() + effort.size() && asked >= first && asked <= last;
}

std::string describe(const EncoderEntry& entry, AVPixelFormat pixels, const std::string& quality,
                     int threads) {
    const std::string_view ending = entry.ending;
    const char* colours = ending == ".mkv"               ? "lossless RGB"
                          : ending == ".gif"             ? "256 colours a frame"
                          : pixels == AV_PIX_FMT_YUV444P ? "yuv444p, BT.709"
                                                         : "yuv420p, BT.709";
    return fmt::format("{} ({}{}, {} threads)", entry.codec, colours, quality, threads);
}

// Quality and effort as the user or else our table has them, and how they are told to the user.
std::string set_quality(const EncoderEntry& entry, const VideoSettings& settings, AVCodecContext& context,
                        Options& options) {
    std::string told;
    const auto refuse = [](const std::string& why) { throw VideoSettingsError(why); };
    if (settings.crf >= 0 && !entry.quality_option)
        refuse(fmt::format("the encoder {} has no quality setting: leave out --crf", entry.codec));
    if (!settings.preset.empty() && !entry.effort_option)
        refuse(fmt::format("the encoder {} has no presets: leave out --preset", entry.codec));
    if (settings.crf >= 0 && (settings.crf < entry.best_quality || settings.crf > entry.worst_quality))
        refuse(fmt::format("--crf {}: {} takes {} (best) to {}{}", settings.crf, entry.codec,
                           entry.best_quality, entry.worst_quality,
                           settings.crf < entry.best_quality ? "; --video mkv is lossless" : ""));
    if (!settings.preset.empty() && !knows_effort(entry, settings.preset))
        refuse(fmt::format("{} has no preset '{}'; it has: {}", entry.codec, settings.preset, entry.efforts));
    if (entry.quality_option) {
        // Thin lines lose their colour first, since it is kept at half the size.
        const int usual = settings.thin_lines ? std::max(entry.quality - 6, 0) : entry.quality;
        const int quality = settings.crf >= 0 ? settings.crf : usual;
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

namespace {

// Frames that keep the colour of every pixel, where that is asked. What stores RGB does so anyhow.
AVPixelFormat pixels_of(const EncoderEntry& entry, const VideoSettings& settings) {
    const bool halved = entry.pixels == AV_PIX_FMT_YUV420P || entry.pixels == AV_PIX_FMT_NV12;
    if (!settings.full_chroma || !halved) return entry.pixels;
    constexpr std::string_view able[] = {"libx264", "libvpx-vp9", "libaom-av1"};
    if (std::ranges::find(able, entry.codec) == std::end(able))
        throw VideoError("it keeps colour at half the size only");
    return AV_PIX_FMT_YUV444P;
}

}  // namespace

OpenEncoder open_encoder(const EncoderEntry& entry, const VideoSettings& settings) {
    const AVCodec* codec = avcodec_find_encoder_by_name(entry.codec);
    if (!codec) throw VideoError("this FFmpeg was built without it");
    if (settings.alpha && entry.pixels != AV_PIX_FMT_0RGB32) throw VideoError("it keeps no transparency");
    auto context = made<Codec>(avcodec_alloc_context3(codec));
    context->width = settings.width;
    context->height = settings.height;
    context->pix_fmt = settings.alpha ? AV_PIX_FMT_RGB32 : pixels_of(entry, settings);
    context->time_base = {settings.fps_den, settings.fps_num};
    context->framerate = {settings.fps_num, settings.fps_den};
    context->sample_aspect_ratio = {1, 1};
    context->thread_count = settings.threads;
    // Repeatable arithmetic, and no version of FFmpeg in the stream.
    context->flags |= AV_CODEC_FLAG_BITEXACT;
    if (std::string_view(entry.ending) != ".gif") context->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    set_keyframes(*context, settings);
    set_colours(*context);

    const LogCapture log;
    Options options;
    av_dict_parse_string(&options.entries, entry.options, "=", ":", 0);
    if (std::string_view(entry.codec).starts_with("libx264") && has_avx512())
        options.set("x264-params", "asm=AVX2");
    const std::string quality = set_quality(entry, settings, *context, options);
    if (const int error = avcodec_open2(context.get(), codec, &options.entries); error < 0)
        throw VideoError(log.explain(error));
    if (const auto* unknown = av_dict_get(options.entries, "", nullptr, AV_DICT_IGNORE_SUFFIX))
        throw VideoError(fmt::format("it does not know the setting {}", unknown->key));
    const AVPixelFormat pixels = context->pix_fmt;
    return {std::move(context), describe(entry, pixels, quality, settings.threads)};
}

namespace {

// Only what the encoder needs in order to open: quality and effort as our table has them.
VideoSettings unset(VideoSettings settings) {
    settings.crf = -1;
    settings.preset.clear();
    return settings;
}

// Whether it opens; why not is added to `failures`.
bool opens(const EncoderEntry& entry, const VideoSettings& settings, std::string& failures) {
    try {
        open_encoder(entry, unset(settings));
        return true;
    } catch (const VideoError& error) {
        failures += fmt::format("{}{}: {}", failures.empty() ? "" : "; ", entry.codec, error.what());
        return false;
    }
}

std::string encoders_that_open(const Container& container, const VideoSettings& settings) {
    std::string names, failures;
    for (const EncoderEntry* entry : encoders_for(container))
        if (opens(*entry, settings, failures))
            names += fmt::format("{}{}", names.empty() ? "" : ", ", entry->codec);
    return names.empty() ? "none" : names;
}

// Lossless containers have an encoder with presets and one without: the one that can be set as asked is
// meant, if there is any.
std::vector<const EncoderEntry*> candidates(const Container& container, const VideoSettings& settings) {
    std::vector<const EncoderEntry*> all = encoders_for(container);
    if (!settings.codec.empty()) {
        std::erase_if(all, [&](const EncoderEntry* entry) { return settings.codec != entry->codec; });
        return all;
    }
    std::vector<const EncoderEntry*> fit = all;
    std::erase_if(fit, [&](const EncoderEntry* entry) {
        return (settings.crf >= 0 && !entry->quality_option) ||
               (!settings.preset.empty() && !entry->effort_option);
    });
    return fit.empty() ? all : fit;
}

}  // namespace

OpenEncoder choose_encoder(const Container& container, const VideoSettings& settings) {
    std::string failures;
    for (const EncoderEntry* entry : candidates(container, settings)) {
        if (!opens(*entry, settings, failures)) continue;
        OpenEncoder opened = open_encoder(*entry, settings);
        if (!failures.empty()) opened.description += fmt::format(", since {}", failures);
        return opened;
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
