#include <malloc.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "base/whole_file.hpp"
#include "render/av.hpp"
#include "render/video.hpp"
#include "render/video_read.hpp"
#include "tests/base/file_size_limit.hpp"
#include "tests/base/temporary_folder.hpp"

using namespace unravel;
using namespace unravel::render;
namespace fs = std::filesystem;

namespace {

constexpr int width = 128, height = 96;

VideoSettings small_settings(int fps = 30) {
    VideoSettings settings;
    settings.width = width;
    settings.height = height;
    settings.fps_num = fps;
    return settings;
}

void fill(Image& image, int x0, int y0, int w, int h, std::array<int, 3> colour) {
    for (int y = y0; y < y0 + h; ++y)
        for (int x = x0; x < x0 + w; ++x)
            for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<std::uint8_t>(colour[c]);
}

Image plain_image(std::array<int, 3> colour) {
    Image image{width, height, std::vector<std::uint8_t>(width * height * 4, 255)};
    fill(image, 0, 0, width, height, colour);
    return image;
}

// The frame's number in binary: eight 16 × 16 patches, white for 1, over a bar that moves.
Image numbered_image(int number) {
    Image image = plain_image({90, 60, 40});
    for (int bit = 0; bit < 8; ++bit) {
        const int level = number >> bit & 1 ? 255 : 0;
        fill(image, 16 * bit, 0, 16, 16, {level, level, level});
    }
    fill(image, number % (width - 8), 40, 8, 40, {200, 30, 60});
    return image;
}

int read_number(const Image& image) {
    int number = 0;
    for (int bit = 0; bit < 8; ++bit) number |= (image.at(16 * bit + 8, 8)[1] > 127 ? 1 : 0) << bit;
    return number;
}

std::string write_numbered(const fs::path& file, const VideoSettings& settings, int frames) {
    VideoWriter writer(file, settings);
    for (int k = 0; k < frames; ++k) writer.add(numbered_image(k));
    writer.finish();
    CHECK(writer.frames() == frames);
    return writer.description();
}

int largest_difference(const Image& a, const Image& b) {
    int largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        if (i % 4 != 3) largest = std::max(largest, std::abs(a.pixels[i] - b.pixels[i]));
    return largest;
}

}  // namespace

TEST_CASE("video_has_every_frame_at_its_time") {
    // The clock's step in each container, in seconds: mp4's is exact, Matroska counts ms, GIF hundredths.
    const struct {
        const char* name;
        int fps_num, fps_den;
        double clock;
    } cases[] = {
        {"clip.mp4", 30, 1, 1e-9},  {"clip.mp4", 30000, 1001, 1e-9}, {"clip.mp4", 24, 1, 1e-9},
        {"clip.webm", 30, 1, 1e-3}, {"clip.mkv", 60, 1, 1e-3},       {"clip.gif", 30, 1, 1e-2},
    };
    for (const auto& c : cases) {
        INFO(c.name << " at " << c.fps_num << "/" << c.fps_den);
        const TemporaryFolder folder;
        VideoSettings settings = small_settings(c.fps_num);
        settings.fps_den = c.fps_den;
        write_numbered(folder / c.name, settings, 60);
        CHECK(folder.entries() == 1);
        int k = 0;
        const VideoFacts facts = read_video(folder / c.name, [&](const Image& image, double seconds) {
            CHECK(read_number(image) == k);
            CHECK(std::abs(seconds - static_cast<double>(k) * c.fps_den / c.fps_num) <= c.clock);
            ++k;
        });
        CHECK(k == 60);
        CHECK(facts.width == width);
        CHECK(facts.height == height);
        CHECK(facts.frames_per_second == Approx(static_cast<double>(c.fps_num) / c.fps_den).epsilon(0.01));
    }
}

TEST_CASE("video_of_any_length_plays") {
    for (const char* name : {"clip.mp4", "clip.webm", "clip.mkv", "clip.gif"})
        for (int frames : {1, 2, 3}) {
            INFO(name << " of " << frames);
            const TemporaryFolder folder;
            write_numbered(folder / name, small_settings(), frames);
            int k = 0;
            read_video(folder / name, [&](const Image& image, double) { CHECK(read_number(image) == k++); });
            CHECK(k == frames);
        }
}

TEST_CASE("rgb_becomes_the_yuv_of_bt709_in_limited_range") {
    // By ITU-R BT.709: Y = 16 + 219 (0.2126 R + 0.7152 G + 0.0722 B), Cb = 128 + 224 (B − Y') / 1.8556,
    // Cr = 128 + 224 (R − Y') / 1.5748, rounded; 1 for swscale's fixed-point matrix. Asked apart from the
    // round trip, which would not see the same mistake made on both ways.
    const struct {
        std::array<std::uint8_t, 4> rgb;
        std::array<int, 3> yuv;
    } cases[] = {{{255, 0, 0, 0}, {63, 102, 240}},
                 {{0, 255, 0, 0}, {173, 42, 26}},
                 {{0, 0, 255, 0}, {32, 240, 118}},
                 {{255, 255, 255, 0}, {235, 128, 128}},
                 {{0, 0, 0, 0}, {16, 128, 128}}};
    for (const auto& c : cases) {
        const Image image = plain_image({c.rgb[0], c.rgb[1], c.rgb[2]});
        const auto converter = av::make_converter(width, height, AV_PIX_FMT_RGB0, AV_PIX_FMT_YUV420P);
        std::vector<std::uint8_t> y(width * height), u(y.size() / 4), v(y.size() / 4);
        const std::uint8_t* rows[] = {image.pixels.data()};
        const int row_bytes[] = {4 * width}, plane_bytes[] = {width, width / 2, width / 2};
        std::uint8_t* planes[] = {y.data(), u.data(), v.data()};
        sws_scale(converter.get(), rows, row_bytes, 0, height, planes, plane_bytes);
        INFO(int(c.rgb[0]) << " " << int(c.rgb[1]) << " " << int(c.rgb[2]));
        const std::vector<std::uint8_t>* got[] = {&y, &u, &v};
        for (int plane = 0; plane < 3; ++plane) {
            const auto [least, most] = std::minmax_element(got[plane]->begin(), got[plane]->end());
            CHECK(*least >= c.yuv[plane] - 1);
            CHECK(*most <= c.yuv[plane] + 1);
        }
    }
}

TEST_CASE("video_keeps_colours") {
    // Patches of one colour hold no detail to lose: what is left is the rounding to 8-bit YUV and back, at
    // most 2, where the matrices of both ways agree. With BT.601 on one side pure red is off by more than 20.
    const std::array<int, 3> colours[] = {{255, 0, 0},   {0, 255, 0},     {0, 0, 255},    {255, 255, 255},
                                          {0, 0, 0},     {128, 128, 128}, {255, 255, 0},  {0, 255, 255},
                                          {255, 0, 255}, {18, 18, 18},    {200, 120, 60}, {30, 90, 160}};
    for (const char* name : {"clip.mp4", "clip.webm"}) {
        const TemporaryFolder folder;
        VideoSettings settings = small_settings();
        settings.crf = 4;  // the encoder's own loss is not what is asked here
        VideoWriter writer(folder / name, settings);
        for (const auto& colour : colours) writer.add(plain_image(colour));
        writer.finish();
        std::size_t k = 0;
        const VideoFacts facts = read_video(folder / name, [&](const Image& image, double) {
            INFO(name << ", colour " << k);
            CHECK(largest_difference(image, plain_image(colours[k++])) <= 2);
        });
        CHECK(k == std::size(colours));
        CHECK(facts.pixel_format == "yuv420p");
        CHECK(facts.primaries == "bt709");
        CHECK(facts.transfer == "bt709");
        CHECK(facts.matrix == "bt709");
        CHECK(facts.range == "tv");
    }
}

TEST_CASE("mkv_is_lossless_with_each_of_its_encoders") {
    for (const EncoderVerdict& verdict : probe_encoders()) {
        if (verdict.ending != ".mkv" || !verdict.opens) continue;
        INFO(verdict.codec);
        const TemporaryFolder folder;
        VideoSettings settings = small_settings();
        settings.codec = verdict.codec;
        write_numbered(folder / "clip.mkv", settings, 12);
        int k = 0;
        read_video(folder / "clip.mkv", [&](const Image& image, double) {
            CHECK(largest_difference(image, numbered_image(k++)) == 0);
        });
        CHECK(k == 12);
    }
}

TEST_CASE("mkv_keeps_transparency_where_asked_and_nothing_else_claims_to") {
    const TemporaryFolder folder;
    VideoSettings settings = small_settings();
    settings.alpha = true;
    Image image = numbered_image(5);
    for (std::size_t k = 3; k < image.pixels.size(); k += 4)
        image.pixels[k] = static_cast<std::uint8_t>(k / 4);
    {
        VideoWriter video(folder / "clip.mkv", settings);
        video.add(image);
        video.finish();
    }
    int frames = 0;
    read_video(folder / "clip.mkv", [&](const Image& read, double) {
        ++frames;
        CHECK(read.pixels == image.pixels);
    });
    CHECK(frames == 1);
    for (const char* name : {"a.mp4", "a.webm", "a.gif"})
        CHECK_THROWS_AS(VideoWriter(folder / name, settings), VideoError);
}

TEST_CASE("gif_shows_few_colours_exactly_and_gradients_closely") {
    const TemporaryFolder folder;
    Image gradient = plain_image({0, 0, 0});
    for (int x = 0; x < width; ++x) fill(gradient, x, 0, 1, height, {2 * x, 255 - 2 * x, 128});
    VideoWriter writer(folder / "clip.gif", small_settings(25));
    writer.add(numbered_image(5));
    writer.add(gradient);
    writer.finish();
    int k = 0;
    read_video(folder / "clip.gif", [&](const Image& image, double) {
        // 128 colours fit into 256; what is allowed is the quantiser's rounding.
        CHECK(largest_difference(image, k++ == 0 ? numbered_image(5) : gradient) <= 4);
    });
    CHECK(k == 2);
}

TEST_CASE("mp4_has_its_index_first_where_asked") {
    const TemporaryFolder folder;
    VideoSettings settings = small_settings();
    write_numbered(folder / "fast.mp4", settings, 10);
    CHECK(read_video(folder / "fast.mp4").index_first);
    settings.faststart = false;
    write_numbered(folder / "slow.mp4", settings, 10);
    CHECK_FALSE(read_video(folder / "slow.mp4").index_first);
}

TEST_CASE("video_has_the_same_bytes_each_time") {
    for (const char* name : {"clip.mp4", "clip.webm", "clip.mkv", "clip.gif"}) {
        INFO(name);
        const TemporaryFolder folder;
        write_numbered(folder / name, small_settings(), 30);
        const auto first = read_whole_file(folder / name, 1 << 24);
        write_numbered(folder / name, small_settings(), 30);
        CHECK(first == read_whole_file(folder / name, 1 << 24));
    }
}

TEST_CASE("video_has_the_same_bytes_whatever_its_memory_held_before") {
    // An encoder that reads what nobody has written takes the bits of what lay there before: on a busy
    // machine that changes from run to run. glibc fills fresh memory with a byte of choice.
    struct Fill {
        explicit Fill(int byte) { mallopt(M_PERTURB, byte); }
        ~Fill() { mallopt(M_PERTURB, 0); }
    };
    const auto busy_image = [](int w, int h, int k) {
        Image image{w, h, std::vector<std::uint8_t>(std::size_t(4) * w * h, 255)};
        std::mt19937 random(static_cast<unsigned>(k) + 1);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const bool inside = std::hypot(x - w * (0.3 + 0.03 * k), y - h * 0.5) < 0.3 * h;
                const auto level =
                    static_cast<std::uint8_t>(inside && (x / 4 + y / 3 + k / 3) % 2 ? 200 : 60);
                for (int c = 0; c < 3; ++c)
                    image.at(x, y)[c] = static_cast<std::uint8_t>(level + 10 * c + random() % 4);
            }
        return image;
    };
    // Rows of 1 to 20 blocks of 16, whole and not.
    const std::array<int, 2> sizes[] = {{16, 16}, {64, 48}, {96, 72}, {144, 96}, {200, 112}, {320, 180}};
    for (const char* name : {"clip.mp4", "clip.webm", "clip.mkv", "clip.gif"})
        for (const auto& [w, h] : sizes) {
            const TemporaryFolder folder;
            VideoSettings settings = small_settings();
            settings.width = w;
            settings.height = h;
            std::vector<std::uint8_t> first;
            for (const int byte : {0, 1, 128, 200}) {
                INFO(name << " of " << w << " x " << h << " in memory of " << byte);
                {
                    const Fill fill(byte);
                    VideoWriter writer(folder / name, settings);
                    for (int k = 0; k < 12; ++k) writer.add(busy_image(w, h, k));
                    writer.finish();
                }
                const auto bytes = read_whole_file(folder / name, 1 << 24);
                if (byte == 0) first = bytes;
                CHECK(bytes == first);
            }
        }
}

TEST_CASE("players_can_jump_to_a_frame_in_each_second") {
    for (const char* name : {"clip.mp4", "clip.webm", "clip.mkv"})
        for (const auto& [num, den] : {std::array{10, 1}, std::array{24000, 1001}}) {
            INFO(name << " at " << num << "/" << den);
            const TemporaryFolder folder;
            VideoSettings settings = small_settings(num);
            settings.fps_den = den;
            write_numbered(folder / name, settings, 60);
            const VideoFacts facts = read_video(folder / name, [](const Image&, double) {});
            REQUIRE(!facts.keyframes.empty());
            CHECK(facts.keyframes.front() == 0);
            const int second = num / den;
            for (std::size_t k = 1; k < facts.keyframes.size(); ++k)
                CHECK(facts.keyframes[k] - facts.keyframes[k - 1] <= second);
            CHECK(60 - facts.keyframes.back() <= second);
        }
}

TEST_CASE("odd_sizes_come_back_whole_where_the_codec_takes_them") {
    for (const char* name : {"clip.webm", "clip.mkv", "clip.gif"}) {
        INFO(name);
        const TemporaryFolder folder;
        VideoSettings settings = small_settings();
        settings.width = 127;
        settings.height = 95;
        Image image{127, 95, std::vector<std::uint8_t>(127 * 95 * 4, 255)};
        fill(image, 0, 0, 127, 95, {90, 60, 40});
        fill(image, 119, 87, 8, 8, {200, 30, 60});  // to the last column and row
        VideoWriter writer(folder / name, settings);
        for (int k = 0; k < 3; ++k) writer.add(image);
        writer.finish();
        int frames = 0;
        const VideoFacts facts = read_video(folder / name, [&](const Image& read, double) {
            ++frames;
            REQUIRE(read.width == 127);
            REQUIRE(read.height == 95);
            for (int c = 0; c < 3; ++c) CHECK(std::abs(read.at(126, 94)[c] - image.at(126, 94)[c]) <= 8);
        });
        CHECK(frames == 3);
        CHECK(facts.width == 127);
    }
}

TEST_CASE("gif_has_the_same_bytes_for_any_number_of_cores") {
    const TemporaryFolder folder;
    // Noise: the quantiser shares its work out only from some thousand colours on.
    std::mt19937 random(11);
    Image image = plain_image({0, 0, 0});
    for (std::uint8_t& value : image.pixels) value = static_cast<std::uint8_t>(random());
    std::vector<std::uint8_t> bytes[3];
    for (int threads : {1, 2, 3}) {
        omp_set_num_threads(threads);
        VideoWriter writer(folder / "clip.gif", small_settings());
        for (int k = 0; k < 3; ++k) writer.add(image);
        writer.finish();
        bytes[threads - 1] = read_whole_file(folder / "clip.gif", 1 << 24);
    }
    CHECK(bytes[0] == bytes[1]);
    CHECK(bytes[0] == bytes[2]);
}

TEST_CASE("video_not_finished_leaves_nothing") {
    const TemporaryFolder folder;
    write_whole_file(folder / "clip.mp4", "old");
    {
        VideoWriter writer(folder / "clip.mp4", small_settings());
        for (int k = 0; k < 5; ++k) writer.add(numbered_image(k));
    }
    CHECK(folder.entries() == 1);
    CHECK(read_whole_file(folder / "clip.mp4", 3).size() == 3);
    {
        VideoWriter writer(folder / "none.mp4", small_settings());
        writer.finish();
    }
    CHECK(folder.entries() == 1);
}

TEST_CASE("video_settings_that_can_not_be_are_refused_in_words") {
    const TemporaryFolder folder;
    const auto refusal = [&](const char* name, auto change) {
        VideoSettings settings = small_settings();
        change(settings);
        try {
            const VideoWriter writer(folder / name, settings);
            return std::string("accepted");
        } catch (const VideoError& error) {
            return std::string(error.what());
        }
    };
    const auto nothing = [](VideoSettings&) {};
    using Catch::Contains;
    CHECK_THAT(refusal("a.mp4", [](auto& s) { s.width = 127; }),
               Contains("127 × 96") && Contains("must be even"));
    CHECK_THAT(refusal("a.mp4", [](auto& s) { s.width = 0; }), Contains("16 to 16384"));
    CHECK_THAT(refusal("a.mp4", [](auto& s) { s.width = 20000; }), Contains("16 to 16384"));
    CHECK_THAT(refusal("a.mp4", [](auto& s) { s.fps_num = 0; }), Contains("frames a second"));
    CHECK_THAT(refusal("a.gif", [](auto& s) { s.fps_num = 60; }), Contains("at most 50 frames a second"));
    CHECK_THAT(refusal("a.avi", nothing), Contains(".mp4, .webm, .mkv or .gif"));
    CHECK_THAT(refusal("a", nothing), Contains(".mp4, .webm, .mkv or .gif"));
    CHECK_THAT(refusal("a.mp4", [](auto& s) { s.preset = "hasty"; }),
               Contains("libx264 has no preset 'hasty'") && Contains("veryfast"));
    CHECK(refusal("a.mp4", [](auto& s) { s.crf = 52; }) == "--crf 52: libx264 takes 1 (best) to 51");
    CHECK(refusal("a.mp4", [](auto& s) { s.crf = 0; }) ==
          "--crf 0: libx264 takes 1 (best) to 51; --video mkv is lossless");
    CHECK(refusal("a.mp4", [](auto& s) { s.codec = "mpeg4", s.crf = 32; }) ==
          "--crf 32: mpeg4 takes 1 (best) to 31");
    CHECK(refusal("a.webm", [](auto& s) { s.crf = 64; }) == "--crf 64: libvpx-vp9 takes 0 (best) to 63");
    CHECK(refusal("a.webm", [](auto& s) { s.preset = "99"; }) ==
          "libvpx-vp9 has no preset '99'; it has: 0 to 9");
    CHECK(refusal("a.webm", [](auto& s) { s.preset = "fast"; }) ==
          "libvpx-vp9 has no preset 'fast'; it has: 0 to 9");
    CHECK(refusal("a.mkv", [](auto& s) { s.crf = 3; }) ==
          "the encoder ffv1 has no quality setting: leave out --crf");
    CHECK(refusal("a.gif", [](auto& s) { s.preset = "slow"; }) ==
          "the encoder gif has no presets: leave out --preset");
    CHECK(folder.entries() == 0);
}

TEST_CASE("a_codec_asked_for_by_name_is_that_one_or_an_error_with_those_that_open") {
    const TemporaryFolder folder;
    VideoSettings settings = small_settings();
    settings.codec = "h265_imaginary";
    CHECK_THROWS_WITH(VideoWriter(folder / "a.mp4", settings), Catch::Contains("h265_imaginary") &&
                                                                   Catch::Contains("open here: ") &&
                                                                   Catch::Contains("mpeg4"));
    // One that FFmpeg has, but not for this container.
    settings.codec = "libvpx-vp9";
    CHECK_THROWS_AS(VideoWriter(folder / "a.mp4", settings), VideoError);
    settings.codec = "mpeg4";
    CHECK_THAT(write_numbered(folder / "a.mp4", settings, 3), Catch::StartsWith("mpeg4"));
    CHECK(read_video(folder / "a.mp4").codec == "mpeg4");
}

TEST_CASE("every_encoder_is_probed_and_says_why_it_does_not_open") {
    const auto verdicts = probe_encoders();
    for (const char* ending : {".mp4", ".webm", ".mkv", ".gif"}) {
        INFO(ending);
        CHECK(std::any_of(verdicts.begin(), verdicts.end(),
                          [&](const EncoderVerdict& v) { return v.ending == ending && v.opens; }));
    }
    for (const EncoderVerdict& verdict : verdicts) {
        INFO(verdict.codec << ": " << verdict.reason);
        CHECK(verdict.opens == verdict.reason.empty());
    }
}

TEST_CASE("video_errors_of_the_disk_name_the_file") {
    const TemporaryFolder folder;
    write_whole_file(folder / "file", "x");
    CHECK_THROWS_WITH(VideoWriter(folder / "file" / "a.mp4", small_settings()),
                      Catch::Contains("file/a.mp4"));
    CHECK_THROWS_AS(VideoWriter(folder / "file" / "a.mp4", small_settings()), OutputError);
    CHECK_THROWS_AS(read_video(folder / "none.mp4"), InputError);
    CHECK_THROWS_AS(read_video(folder / "file"), InputError);
}

TEST_CASE("a_disk_that_fills_up_under_a_video_is_an_error_and_leaves_nothing") {
    const TemporaryFolder folder;
    for (const char* name : {"clip.mp4", "clip.webm", "clip.mkv", "clip.gif"}) {
        INFO(name);
        // Small enough that it is met while frames are added, or only when the trailer is written.
        for (int bytes : {64, 4000}) {
            const FileSizeLimit limit(bytes);
            CHECK_THROWS_AS(write_numbered(folder / name, small_settings(), 100), OutputError);
        }
    }
    CHECK(folder.entries() == 0);
}

TEST_CASE("a_frame_of_another_size_is_refused") {
    const TemporaryFolder folder;
    VideoWriter writer(folder / "a.mp4", small_settings());
    CHECK_THROWS_AS(writer.add(Image{64, 64, std::vector<std::uint8_t>(64 * 64 * 4)}), std::invalid_argument);
}
