#include <utility>

#include "render/gl_context.hpp"
#include "tests/render/gl_test.hpp"

using namespace unravel;
using namespace unravel::render;

TEST_CASE("device_choice_reads_its_four_forms_and_refuses_others") {
    CHECK(parse_device_choice("auto").kind == DeviceChoice::Kind::automatic);
    CHECK(parse_device_choice("gpu").kind == DeviceChoice::Kind::gpu);
    CHECK(parse_device_choice("software").kind == DeviceChoice::Kind::software);
    CHECK(parse_device_choice("3").kind == DeviceChoice::Kind::index);
    CHECK(parse_device_choice("3").index == 3);
    for (const char* wrong : {"", "GPU", "-1", "1x", "0 ", "99999999999"})
        CHECK_THROWS_AS(parse_device_choice(wrong), RendererError);
}

TEST_CASE("GL_context_says_what_it_is_and_why") {
    const auto context = testing::open_renderer();
    if (!context) return;
    CHECK_FALSE(context->renderer().empty());
    CHECK(context->summary().find(context->renderer()) != std::string::npos);
    CHECK(context->summary().find('\n') == std::string::npos);
    CHECK(context->max_samples() >= 4);  // GL 3.3 promises four
    int taken = 0;
    for (const RendererAttempt& attempt : context->attempts())
        taken += attempt.usable && attempt.reason.empty();
    CHECK(taken == 1);
}

TEST_CASE("GL_every_route_has_a_verdict_and_each_failure_its_fix") {
    if (!testing::open_renderer()) return;
    const std::vector<RendererAttempt> attempts = probe_renderers();
    CHECK_FALSE(attempts.empty());
    for (const RendererAttempt& attempt : attempts) {
        INFO(attempt.route);
        CHECK(attempt.usable == attempt.reason.empty());
        CHECK(attempt.usable == attempt.fix.empty());
        CHECK(attempt.usable == !attempt.renderer.empty());
    }
}

TEST_CASE("GL_asking_for_a_gpu_never_falls_back_to_software") {
    if (!testing::open_renderer()) return;
    bool has_gpu = false;
    for (const RendererAttempt& attempt : probe_renderers()) has_gpu |= attempt.usable && !attempt.software;
    if (has_gpu) {
        CHECK_FALSE(GlContext({DeviceChoice::Kind::gpu}).software());
    } else {
        CHECK_THROWS_AS(GlContext({DeviceChoice::Kind::gpu}), RendererError);
        CHECK_THROWS_WITH(GlContext({DeviceChoice::Kind::gpu}), Catch::Contains("--device gpu"));
    }
}

TEST_CASE("GL_a_device_number_that_does_not_exist_is_refused") {
    if (!testing::open_renderer()) return;
    CHECK_THROWS_WITH(GlContext({DeviceChoice::Kind::index, 1000}), Catch::Contains("doctor"));
}

TEST_CASE("GL_software_can_be_asked_for") {
    bool has_software = false;
    for (const RendererAttempt& attempt : probe_renderers())
        has_software |= attempt.usable && attempt.software;
    if (!has_software) {
        WARN("skipped: no software renderer");
        return;
    }
    CHECK(GlContext({DeviceChoice::Kind::software}).software());
}

TEST_CASE("GL_a_moved_context_lives_on_and_dies_once") {
    auto context = testing::open_renderer();
    if (!context) return;
    const std::string name = context->renderer();
    GlContext moved = std::move(*context);
    context.reset();
    CHECK(moved.renderer() == name);
}
