#include "tool/cli/picture_options.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

Scene two_cameras() {
    Scene scene = testing::drape();
    scene.clip.duration = 1;
    scene.cameras.resize(2);
    scene.cameras[0].name = "front";
    scene.cameras[1].name = "close up";
    return scene;
}

std::vector<std::string> view_names(const PictureOptions& options) {
    Scene scene = two_cameras();
    std::vector<std::string> names;
    for (const ClipView& view : clip_options_of(options, scene).views) names.push_back(view.name);
    return names;
}

}  // namespace

TEST_CASE("views_are_named_after_layout_and_camera") {
    using Names = std::vector<std::string>;
    PictureOptions options;
    CHECK(view_names(options) == Names{"textured", "components"});
    options.style = "side-by-side,overlay";
    CHECK(view_names(options) == Names{"side_by_side", "overlay"});
    options.camera = "all";
    options.style = "both";
    CHECK(view_names(options) == Names{"textured", "components", "textured_close_up", "components_close_up"});
    options.camera = "close up";
    options.style = "textured";
    CHECK(view_names(options) == Names{"textured_close_up"});
    for (const char* style : {"textured,textured", "fancy", ""}) {
        options.style = style;
        CHECK_THROWS_AS(view_names(options), UsageError);
    }
    options.style = "both";
    options.camera = "back";
    CHECK_THROWS_AS(view_names(options), UsageError);
}

TEST_CASE("a_still_is_one_frame_without_a_video_and_transparency_goes_where_it_is_kept") {
    Scene scene = two_cameras();
    PictureOptions options;
    options.still = 7;
    ClipOptions clip = clip_options_of(options, scene);
    CHECK(clip.first == 7);
    CHECK(clip.last == 7);
    CHECK(clip.video_ending.empty());
    options.still = 26;
    CHECK_THROWS_AS(clip_options_of(options, scene), UsageError);
    options.still = -1;
    CHECK(clip_options_of(options, scene).video_ending == ".mp4");
    options.transparent = true;
    CHECK(clip_options_of(options, scene).video_ending == ".mkv");
    CHECK(scene.look.transparent);
}

TEST_CASE("one_thing_is_drawn_once_for_all_views_that_show_it") {
    const Scene scene = two_cameras();
    CHECK(shots_of(make_view(scene, Layout::side_by_side, 1)) ==
          std::vector<Shot>{{DrawStyle::textured, 1}, {DrawStyle::components, 1}});
    CHECK(shots_of(make_view(scene, Layout::overlay, 0)) == std::vector<Shot>{{DrawStyle::overlay, 0}});
    CHECK(view_width(Layout::side_by_side, 640) == 1280);
}
