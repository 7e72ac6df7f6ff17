#include "tool/report/preview.hpp"

#include <webp/encode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "render/color.hpp"

namespace unravel::tool {

namespace {

// What a lossy picture of cloth takes, rounded up from measured clips: wires 0.11 bytes per pixel at most.
constexpr double bytes_per_pixel = 0.11;
constexpr double base64_growth = 4.0 / 3.0;
constexpr int narrowest = 320, widest = 960;

const std::array<float, 256>& linear_light() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (std::size_t k = 0; k < t.size(); ++k) t[k] = srgb_to_linear(static_cast<float>(k) / 255);
        return t;
    }();
    return table;
}

// sRGB bytes of linear light in steps of 1/4095: within one of the exact byte.
const std::array<std::uint8_t, 4096>& encoded_light() {
    static const std::array<std::uint8_t, 4096> table = [] {
        std::array<std::uint8_t, 4096> t{};
        for (std::size_t k = 0; k < t.size(); ++k)
            t[k] = static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(static_cast<float>(k) / 4095)));
        return t;
    }();
    return table;
}

struct WebpDeleter {
    void operator()(std::uint8_t* memory) const { WebPFree(memory); }
};

}  // namespace

Image shrink(const Image& image, int width) {
    width = std::clamp(width, 1, image.width);
    Image out;
    out.width = width;
    out.height =
        std::max(1, static_cast<int>(std::lround(static_cast<double>(image.height) * width / image.width)));
    out.pixels.resize(static_cast<std::size_t>(out.width) * out.height * 4);
    const auto& light = linear_light();
    const auto& encoded = encoded_light();
    for (int y = 0; y < out.height; ++y) {
        const int top = y * image.height / out.height;
        const int bottom = std::max(top + 1, (y + 1) * image.height / out.height);
        for (int x = 0; x < out.width; ++x) {
            const int left = x * image.width / out.width;
            const int right = std::max(left + 1, (x + 1) * image.width / out.width);
            float sum[3] = {0, 0, 0};
            for (int j = top; j < bottom; ++j) {
                for (int i = left; i < right; ++i) {
                    for (int c = 0; c < 3; ++c) sum[c] += light[image.at(i, j)[c]];
                }
            }
            const float count = static_cast<float>((bottom - top) * (right - left));
            for (int c = 0; c < 3; ++c)
                out.at(x, y)[c] = encoded[static_cast<std::size_t>(std::lround(4095 * sum[c] / count))];
            out.at(x, y)[3] = 255;
        }
    }
    return out;
}

std::vector<std::uint8_t> encode_webp(const Image& image, float quality) {
    std::uint8_t* bytes = nullptr;
    const std::size_t size =
        WebPEncodeRGBA(image.pixels.data(), image.width, image.height, 4 * image.width, quality, &bytes);
    const std::unique_ptr<std::uint8_t, WebpDeleter> owner(bytes);
    if (size == 0) throw std::runtime_error("the WebP encoder made no picture");
    return {bytes, bytes + size};
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto byte = [&](std::size_t i) { return i < bytes.size() ? std::uint32_t{bytes[i]} : 0u; };
        const std::uint32_t group = byte(k) << 16 | byte(k + 1) << 8 | byte(k + 2);
        for (int d = 0; d < 4; ++d) text += digits[group >> (18 - 6 * d) & 63];
    }
    const std::size_t padding = (3 - bytes.size() % 3) % 3;
    text.replace(text.size() - padding, padding, padding, '=');
    return text;
}

Previews::Previews(int width, int height, int pictures, std::size_t budget,
                   const std::filesystem::path& folder)
    : budget_(budget), share_(budget / static_cast<std::size_t>(std::max(pictures, 1))), buffer_(folder) {
    const double pixels =
        static_cast<double>(budget) / (base64_growth * bytes_per_pixel * std::max(pictures, 1));
    const double shape = static_cast<double>(width) / height;
    width_ = std::min(std::clamp(static_cast<int>(std::sqrt(pixels * shape)), narrowest, widest), width);
}

void Previews::add(const std::string& view, int frame, const Image& image) {
    const Image small = shrink(image, width_);
    std::string text = base64(encode_webp(small));
    // The size was chosen for pictures as they usually are; a busier one pays in quality, not in the budget.
    for (const float quality : {50.f, 20.f, 5.f}) {
        if (text.size() <= share_) break;
        text = base64(encode_webp(small, quality));
    }
    const std::lock_guard lock(mutex_);
    bytes_ += text.size();
    pictures_[view][frame] = {buffer_.append(std::as_bytes(std::span(text))), text.size()};
}

std::vector<int> Previews::frames(const std::string& view) const {
    std::vector<int> numbers;
    if (const auto found = pictures_.find(view); found != pictures_.end())
        for (const auto& [frame, place] : found->second) numbers.push_back(frame);
    return numbers;
}

std::string Previews::text(const std::string& view, int frame) const {
    const Place& place = pictures_.at(view).at(frame);
    std::string text(place.size, '\0');
    buffer_.read(place.begin, std::as_writable_bytes(std::span(text)));
    return text;
}

}  // namespace unravel::tool
