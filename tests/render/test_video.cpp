#include <malloc.h>

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
#include "render/video_palette.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tests/render/numbered_video.hpp"
#include "tests/render/video_read.hpp"

using namespace unravel;
using namespace unravel::render;
using namespace unravel::testing;
namespace fs = std::filesystem;

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

TEST_CASE("a_gif_frame_depends_on_its_picture_alone") {
    std::mt19937 random(11);
    Image noise = plain_image({0, 0, 0});
    for (std::uint8_t& value : noise.pixels) value = static_cast<std::uint8_t>(random());
    const auto quantized = [&](const std::vector<Image>& pictures) {
        av::Quantizer quantizer(width, height);
        const auto frame = av::made<av::Frame>(av_frame_alloc());
        frame->format = AV_PIX_FMT_PAL8;
        frame->width = width;
        frame->height = height;
        REQUIRE(av_frame_get_buffer(frame.get(), 0) == 0);
        for (const Image& picture : pictures) quantizer.fill(picture, *frame);
        std::vector<std::uint8_t> bytes(frame->data[1], frame->data[1] + AVPALETTE_SIZE);
        for (int y = 0; y < height; ++y) {
            const std::uint8_t* row = frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0];
            bytes.insert(bytes.end(), row, row + width);
        }
        return bytes;
    };
    const auto alone = quantized({noise});
    CHECK(alone == quantized({numbered_image(3), plain_image({200, 10, 30}), noise}));
    CHECK(alone != quantized({noise, numbered_image(3)}));
}

TEST_CASE("full_chroma_keeps_the_colour_of_lines_one_pixel_wide") {
    const TemporaryFolder folder;
    // Lines of red and blue side by side: at half the size both would be purple.
    Image image = plain_image({20, 20, 20});
    for (int x = 0; x < width; x += 2) {
        fill(image, x, 0, 1, height, {220, 30, 30});
        fill(image, x + 1, 0, 1, height, {40, 60, 220});
    }
    for (const char* ending : {".mp4", ".webm"}) {
        VideoSettings settings = small_settings();
        settings.thin_lines = settings.full_chroma = true;
        const fs::path file = folder.path() / (std::string("lines") + ending);
        VideoWriter writer(file, settings);
        for (int k = 0; k < 3; ++k) writer.add(image);
        writer.finish();
        CHECK(writer.description().find("yuv444p") != std::string::npos);
        Image back;
        CHECK(read_video(file, [&](const Image& frame, double) { back = frame; }).pixel_format == "yuv444p");
        CHECK(std::abs(back.at(64, 48)[0] - 220) < 24);
        CHECK(std::abs(back.at(65, 48)[2] - 220) < 24);
        CHECK(back.at(65, 48)[0] < 80);
    }
}
