// The study of what accuracy costs: its numbers from points known by hand, and a small study whole.

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "sim/run/simulate.hpp"
#include "tool/study/accuracy/accuracy_contrast.hpp"
#include "tool/study/accuracy/accuracy_study.hpp"
#include "tool/study/accuracy/accuracy_verdict.hpp"
#include "tool/study/accuracy/accuracy_video.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

// Error and time of a method of order p: error = c/steps^p, time = t·steps.
void add_method(AccuracyStudy& study, Integrator integrator, double c, double order, double seconds) {
    for (int steps = 1; steps <= 64; steps *= 2) {
        AccuracyPoint point;
        point.setting.integrator = integrator;
        point.setting.steps_per_frame = steps;
        point.error = c / std::pow(steps, order);
        point.seconds = {seconds * steps};
        study.points.push_back(point);
    }
}

AccuracyStudy made_up() {
    AccuracyStudy study;
    study.scene.clip.fps = 25;
    study.reference.frames = 25;
    study.reference.floor = 1e-6;
    return study;
}

Scene small_trampoline() {
    Scene scene;
    scene.name = "small";
    Cloth cloth;
    cloth.particles = {7, 7};
    cloth.placed_scale = {1.08, 1.08};
    for (const char* edge : {"u0", "u1", "v0", "v1"}) {
        Pin frame;
        frame.target = PinTarget::edge;
        frame.name = edge;
        cloth.pins.push_back(frame);
    }
    scene.cloths.push_back(cloth);
    scene.clip.fps = 25;
    scene.clip.duration = 0.12;
    return scene;
}

}  // namespace

TEST_CASE("cost at an error lies on the line between two points on log scales") {
    AccuracyStudy study = made_up();
    add_method(study, Integrator::implicit, 0.1, 1, 0.01);
    const std::vector<AccuracyCurve> curves = curves_of(study.points, study.reference.floor);
    REQUIRE(curves.size() == 1);
    CHECK(*curves[0].order == Approx(1.0));
    CHECK(*cost_at(curves[0], 0.1 / std::sqrt(8.0)) == Approx(0.01 * std::sqrt(8.0)));
    CHECK(*cost_at(curves[0], 0.5) == Approx(0.01));  // its coarsest run is better than asked
    CHECK_FALSE(cost_at(curves[0], 1e-5));
}

// First order is cheaper for large errors, second order for small ones.
TEST_CASE("words of the contrast name the winner of each range of errors") {
    AccuracyStudy soft = made_up(), stiff = made_up();
    add_method(soft, Integrator::explicit_, 0.01, 1, 0.001);
    add_method(soft, Integrator::implicit, 0.1, 1, 0.01);
    add_method(soft, Integrator::adaptive_imex, 0.1, 1, 0.008);
    add_method(stiff, Integrator::implicit, 0.1, 1, 0.01);
    add_method(stiff, Integrator::bdf2, 0.4, 2, 0.02);
    add_method(stiff, Integrator::adaptive_imex, 0.1, 1, 0.008);
    const std::string words = contrast_words(soft, stiff, 100);
    INFO(words);
    CHECK(words.find("explicit is cheapest") != std::string::npos);
    CHECK(words.find("adaptive-imex is cheapest") < words.find("bdf2 is cheapest"));
    CHECK(words.find("against implicit at the same error it takes 80 to 80% of the time") !=
          std::string::npos);
    // As it is explicit beats both; stiffer it was not tried, and adaptive IMEX is the better of the two.
    CHECK(words.find("Adaptive-imex is everywhere dearer than the better of explicit and implicit") !=
          std::string::npos);
    CHECK(words.find("Adaptive-imex is never dearer than the better of explicit and implicit") !=
          std::string::npos);
}

TEST_CASE("words of the contrast say what auto takes, and never that it is the winner") {
    AccuracyStudy study = made_up();
    add_method(study, Integrator::explicit_, 0.01, 1, 0.001);
    add_method(study, Integrator::automatic, 0.01, 1, 0.0009);
    CHECK(contrast_words(study, study, 2).find("Auto takes explicit substeps; auto is never dearer") !=
          std::string::npos);
    for (AccuracyPoint& p : study.points) p.rvm = p.setting.integrator == Integrator::automatic;
    const std::string words = contrast_words(study, study, 2);
    INFO(words);
    CHECK(words.find("Auto takes adaptive IMEX") != std::string::npos);
    CHECK(words.find("auto is cheapest") == std::string::npos);
}

TEST_CASE("explicit steps of a study are parts of one step a frame, the same as steps of their own") {
    const auto keep_on = [] { return true; };
    const Scene scene = small_trampoline();
    AccuracySetting setting;
    setting.integrator = Integrator::explicit_;
    setting.steps_per_frame = 16;
    const AccuracyRun run = run_setting(scene, setting, 2, keep_on);
    CHECK(run.point.steps == 32);
    CHECK(run.point.rvm == 0);
    Scene steps = scene;
    steps.solver.integrator = Integrator::explicit_;
    steps.solver.step = 1.0 / (16 * scene.clip.fps.per_second());
    Simulation simulation = start_simulation(steps);
    for (int k = 0; k < 2; ++k) next_record(simulation);
    CHECK(distance(run.trajectory, {run.trajectory[0], simulation.state.x}, 1) < 1e-12);
}

TEST_CASE(
    "a study tries the scene's own solver first, refines nothing beyond the error, and runs what it names "
    "again") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "unravel_test_accuracy_budget";
    std::filesystem::remove_all(folder);
    const auto keep_on = [] { return true; };
    Scene scene = small_trampoline();
    scene.clip.duration = 0.4;
    scene.solver.step = 1.0 / 75;
    scene.solver.threshold = 0.3;  // as no point of the grid has it
    AccuracyBudget budget{240, true, true};
    budget.error = 0.02;
    budget.window = {3, 8};
    const AccuracyStudy study = study_accuracy(scene, folder, budget, keep_on);
    REQUIRE(!study.points.empty());
    CHECK(study.points.front().setting == scene_setting(scene));
    CHECK(study.reference.first_frame == 3);
    CHECK(study.reference.frames == 5);
    // All settings start where the scene's own solver has come to.
    Simulation simulation = start_simulation(scene);
    for (int k = 0; k < 3; ++k) next_record(simulation);
    CHECK(study.reference.start.x == simulation.state.x);
    // No method has two points, of its integrator's plain settings three, that keep within the error.
    for (const AccuracyCurve& curve : curves_of(study.points, study.reference.floor)) {
        INFO(curve.method);
        const auto within =
            std::count_if(curve.points.begin(), curve.points.end(),
                          [&](const AccuracyPoint* p) { return !p->broke && p->error <= budget.error; });
        CHECK(within <= (curve.points.front()->setting.plain() ? 2 : 1));
    }
    // What is recommended was run again.
    const AccuracyPoint* best = nullptr;
    for (const AccuracyPoint& p : study.points)
        if (!p.broke && p.error <= budget.error && (!best || p.median() < best->median())) best = &p;
    REQUIRE(best);
    CHECK(best->seconds.size() > 1);
    // The same window goes on, another one starts anew.
    const AccuracyReference before = study.reference;
    budget.force = false;
    CHECK(study_accuracy(scene, folder, budget, keep_on).reference.trajectory == before.trajectory);
    budget.window = {0, 4};
    CHECK(study_accuracy(scene, folder, budget, keep_on).reference.frames == 4);
    std::filesystem::remove_all(folder);
}

TEST_CASE("points of a study come back from its table as they were") {
    AccuracyStudy study = made_up();
    add_method(study, Integrator::adaptive_imex2, 0.3, 2, 0.02);
    add_method(study, Integrator::automatic, 0.3, 2, 0.02);
    study.points[1].broke = true;
    study.points[2].setting.bend = BendTreatment::explicit_;
    study.points[2].setting.threshold = 0.05;
    study.points[3].seconds = {0.25, 0.5, 0.125};
    const std::vector<AccuracyPoint> back = read_accuracy_csv(accuracy_csv(study.points));
    REQUIRE(back.size() == study.points.size());
    for (std::size_t k = 0; k < back.size(); ++k) {
        CHECK(back[k].setting == study.points[k].setting);
        CHECK(back[k].broke == study.points[k].broke);
        CHECK(back[k].error == study.points[k].error);
        CHECK(back[k].seconds == study.points[k].seconds);
    }
}

TEST_CASE("heat goes from slate to vermilion over three decades") {
    CHECK(heat_color(0, 1) == heat_color(1e-4, 1));
    CHECK(heat_color(1, 1) == Rgb{213, 94, 0});
    CHECK(heat_color(0.1, 1) == Rgb{240, 228, 66});
    CHECK(heat_color(0.1, 0) == heat_color(0, 1));
}

TEST_CASE("a small study converges and goes on from its folder") {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / "unravel_test_accuracy_study";
    std::filesystem::remove_all(folder);
    const auto keep_on = [] { return true; };
    AccuracyBudget budget{60, false, true};
    budget.error = 1e-7;  // as far as the reference bears
    const AccuracyStudy first = study_accuracy(small_trampoline(), folder, budget, keep_on);
    REQUIRE(first.points.size() > 20);
    CHECK(first.reference.floor < 1e-3);
    // Every scheme converges: its finest run is better than its coarsest that did not break.
    for (const AccuracyCurve& curve : curves_of(first.points, first.reference.floor)) {
        if (!curve.points.front()->setting.plain() || curve.points.front()->broke) continue;
        INFO(curve.method);
        CHECK(curve.points.back()->error < curve.points.front()->error);
    }
    const AccuracyStudy again = study_accuracy(small_trampoline(), folder, budget, keep_on);
    REQUIRE(again.points.size() >= first.points.size());
    for (std::size_t k = 0; k < first.points.size(); ++k)
        CHECK(again.points[k].error == first.points[k].error);
    std::filesystem::remove_all(folder);
}
