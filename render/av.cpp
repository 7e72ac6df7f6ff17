#include "render/av.hpp"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <array>
#include <cstdarg>
#include <mutex>
#include <stdexcept>

namespace unravel::render::av {
namespace {

// FFmpeg's log callback is one for the whole process and gets no pointer of ours, so the way back to the
// capture is this; being per thread, it needs no lock.
thread_local std::string* captured = nullptr;

void log_message(void* source, int level, const char* format, va_list arguments) {
    if (level > AV_LOG_ERROR || !captured || captured->size() > 2000) return;
    std::array<char, 512> line{};
    int prefix = 0;
    av_log_format_line(source, level, format, arguments, line.data(), static_cast<int>(line.size()), &prefix);
    std::string_view text(line.data());
    if (prefix == 0 && text.starts_with('[') && text.find("] ") != text.npos)
        text.remove_prefix(text.find("] ") + 2);  // "[libx264 @ 0x55…] ": an address tells a user nothing
    while (text.ends_with('\n') || text.ends_with(' ') || text.ends_with('.')) text.remove_suffix(1);
    if (text.empty()) return;
    if (!captured->empty()) *captured += "; ";
    *captured += text;
}

bool is_rgb(AVPixelFormat format) {
    return (av_pix_fmt_desc_get(format)->flags & AV_PIX_FMT_FLAG_RGB) != 0;
}

}  // namespace

std::string error_text(int error) {
    std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
    av_strerror(error, text.data(), text.size());
    return text.data();
}

LogCapture::LogCapture() : outer_(captured) {
    static std::once_flag installed;
    std::call_once(installed, [] { av_log_set_callback(log_message); });
    captured = &text_;
}

LogCapture::~LogCapture() {
    captured = outer_;
}

std::string LogCapture::explain(int error) const {
    return text_.empty() ? error_text(error) : fmt::format("{} ({})", error_text(error), text_);
}

Scaler make_converter(int width, int height, AVPixelFormat from, AVPixelFormat to, AVColorSpace yuv) {
    auto scaler = made<Scaler>(sws_alloc_context());
    const auto set = [&](const char* name, int value) { av_opt_set_int(scaler.get(), name, value, 0); };
    set("srcw", width);
    set("srch", height);
    set("src_format", from);
    set("dstw", width);
    set("dsth", height);
    set("dst_format", to);
    set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT);
    // Chroma between two rows and on the even columns: what H.264 and its successors mean where they say
    // nothing.
    const char* side = is_rgb(from) ? "dst" : "src";
    set(fmt::format("{}_h_chr_pos", side).c_str(), 0);
    set(fmt::format("{}_v_chr_pos", side).c_str(), 128);
    const int* matrix = sws_getCoefficients(yuv);
    // Without this call swscale converts with BT.601's coefficients, whatever the tags say.
    sws_setColorspaceDetails(scaler.get(), matrix, is_rgb(from), matrix, is_rgb(to), 0, 1 << 16, 1 << 16);
    if (sws_init_context(scaler.get(), nullptr, nullptr) < 0)
        throw std::runtime_error("the pixel converter (libswscale) does not start");
    return scaler;
}

}  // namespace unravel::render::av
