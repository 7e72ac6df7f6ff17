// What a video is refused for, and what is left when one fails.

#include <catch2/catch.hpp>
#include <string>

#include "base/whole_file.hpp"
#include "render/av.hpp"
#include "render/video.hpp"
#include "tests/base/file_size_limit.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tests/render/numbered_video.hpp"
#include "tests/render/video_read.hpp"

using namespace unravel;
using namespace unravel::render;
using namespace unravel::testing;
namespace fs = std::filesystem;

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
