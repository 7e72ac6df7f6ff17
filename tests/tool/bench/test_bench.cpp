
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/scene_file/load.hpp"
#include "source_dir.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tests/json_schema.hpp"
#include "tests/sim/scenes.hpp"
#include "tool/base/exit.hpp"
#include "tool/bench/measured_problem.hpp"
#include "tool/bench/peers.hpp"
#include "tool/bench/sized_scene.hpp"
#include "tool/bench/speed_report.hpp"
#include "tool/cli/commands.hpp"
#include "tool/report/page_files.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

nlohmann::json json_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return nlohmann::json::parse(stream);
}

// A size whose step takes `seconds` on one thread and as told on two.
SizeRecord made_up(double particles, double one, double two) {
    SizeRecord size;
    size.particles = particles;
    const auto step = [](int threads, double seconds) {
        StepRecord record;
        record.name = own_step;
        record.threads = threads;
        record.seconds = spread_of({seconds});
        record.stages.solve = 0.5 * seconds;
        return record;
    };
    size.steps = {step(1, one), step(2, two)};
    return size;
}

const Goal& goal_of(const std::vector<Goal>& goals, const std::string& start) {
    for (const Goal& goal : goals)
        if (goal.what.starts_with(start)) return goal;
    throw std::runtime_error("no such goal: " + start);
}

}  // namespace

TEST_CASE("a power law is found again from its points", "[bench]") {
    std::vector<Measured> points;
    for (const double n : {2500.0, 10000.0, 40000.0, 160000.0})
        points.push_back({n, 3e-7 * std::pow(n, 1.47)});
    const PowerLaw law = fit_power(points);
    CHECK(law.exponent == Approx(1.47));
    CHECK(law.factor == Approx(3e-7));
    CHECK(law.at(1e6) == Approx(3e-7 * std::pow(1e6, 1.47)));

    points.front().t *= 100;
    CHECK(fit_power(points).exponent < 1.2);
    CHECK(fit_power(points, 8000).exponent == Approx(1.47));
    CHECK(fit_power(points, 8000).points == 3);

    CHECK_FALSE(fit_power(points, 1e5).known());
    const std::vector<Measured> same{{100, 1}, {100, 2}}, nothing{{100, 0}, {200, -1}};
    CHECK_FALSE(fit_power(same).known());
    CHECK_FALSE(fit_power(nothing).known());
}

TEST_CASE("a serial share is what Amdahl's law gave", "[bench]") {
    for (const double s : {0.0, 0.1, 0.5, 1.0})
        for (const int p : {2, 8})
            CHECK(serial_share(3.0, 3.0 * (s + (1 - s) / p), p) == Approx(s).margin(1e-12));
    // Faster than p times, slower than one: noise.
    CHECK(serial_share(3.0, 1.0, 2) == 0);
    CHECK(serial_share(3.0, 3.5, 2) == 1);
    CHECK(serial_share(3.0, 3.0, 1) == 1);
}

TEST_CASE("the account of work and span bounds what threads bring", "[bench]") {
    Account account;
    account.stages = {{"forces", 2.0, 0.0}, {"graph", 1.0, 1.0}};
    account.components = {4.0, 0.5, 0.5};
    account.levels = {{0.75, 100'000'000}, {0.25, 1}};
    account.serial = 0.0;
    CHECK(account.work() == Approx(8.0));
    // The graph, and the level that is one task.
    CHECK(account.span() == Approx(1.0 + 1.0));
    CHECK(account.speed_up(1) == Approx(1.0));
    // On two threads the largest takes 1.5 + 1, all components shared 2.5.
    CHECK(account.time(2) == Approx(1.0 + 1.0 + 2.5));
    CHECK(account.components_alone() == Approx(8.0 / 7.0));
    double before = account.time(1);
    for (const int p : {2, 4, 8, 16, 32, 64}) {
        CHECK(account.time(p) <= before);
        CHECK(account.time(p) >= account.span());
        CHECK(account.time(p) >= account.work() / p);
        before = account.time(p);
    }
    // Many equal components need nothing inside.
    account.components.assign(64, 1.0);
    account.stages.clear();
    account.serial = 1.0;
    CHECK(account.speed_up(16) == Approx(16.0));
}

TEST_CASE("levels of a grid share its work, a quarter each of the one above", "[bench]") {
    const std::vector<LevelWork> levels = levels_of_grid(100, 100, 3, 2048);
    REQUIRE(levels.size() == 3);
    double all = 0;
    for (const LevelWork& level : levels) all += level.share;
    CHECK(all == Approx(1.0));
    CHECK(levels[1].share == Approx(levels[0].share / 4));
    CHECK(levels[0].tasks == 5);
    CHECK(levels[1].tasks == 2);
    CHECK(levels[2].tasks == 1);
}

TEST_CASE("sizes are read, sorted, and refused with the word that is wrong", "[bench]") {
    CHECK(parse_sizes("10000,2500,10000") == std::vector<std::size_t>{2500, 10000});
    for (const char* wrong : {"", "2500,", "many", "2500;10000", "3", "1e6", "99999999999999999999"})
        CHECK_THROWS_AS(parse_sizes(wrong), UsageError);
    CHECK(particles_near(10000, {51, 51}) == std::array<int, 2>{100, 100});
    const auto [u, v] = particles_near(160000, {38, 52});
    CHECK(std::abs(u * v / 160000.0 - 1) < 0.01);
    CHECK(std::abs(static_cast<double>(u) / v / (38.0 / 52.0) - 1) < 0.01);
    const TemporaryFolder folder;
    std::ofstream(folder / "two.toml") << "[[cloth]]\nname = \"a\"\n[[cloth]]\nname = \"b\"\n";
    CHECK_THROWS_AS(scene_of_size(folder / "two.toml", {}, 2500), UsageError);
}

TEST_CASE("goals are judged where their size was measured", "[bench]") {
    SpeedBench bench;
    bench.threads = 2;
    bench.memory_triad = {26, 32};
    bench.sizes = {made_up(2500, 1e-3, 1e-3), made_up(10000, 5e-3, 3e-3)};
    CHECK(goal_of(judge_goals(bench), "time of a step").met == -1);
    CHECK(goal_of(judge_goals(bench), "a step on two threads").met == -1);
    bench.sizes.push_back(made_up(40000, 2e-2, 1e-2));
    CHECK(goal_of(judge_goals(bench), "time of a step").met == 1);
    CHECK(goal_of(judge_goals(bench), "a step on two threads").met == 1);
    bench.sizes.push_back(made_up(160000, 2e-1, 1.9e-1));
    CHECK(goal_of(judge_goals(bench), "time of a step").met == 0);
    CHECK(goal_of(judge_goals(bench), "a step on two threads").met == 0);
    CHECK(step_law(bench, &StageTimes::solve, 1).exponent == Approx(step_law(bench, nullptr, 1).exponent));
}

TEST_CASE("Eigen solves the captured system to what we solve it to", "[bench]") {
    // With contact and friction: full, partial and no constraints, several components.
    MeasuredProblem problem(testing::drape(), 0.4, 1);
    problem.capture(1);
    const FoldedSystem folded = problem.folded();
    REQUIRE(folded.rows() > 100);
    CHECK(folded.rows() == problem.components().start.back());
    CHECK(problem.constrained() > 0);
    CHECK((folded.A - Eigen::SparseMatrix<double>(folded.A.transpose())).norm() <= 1e-14 * folded.A.norm());
    const PeerSolve exact = solve_by_eigen_ldlt(folded);
    CHECK(folded.residual(exact.y) < 1e-11);
    for (const Preconditioner kind :
         // The solver measures by S b, the folded system by S (b - A z): what contacts prescribe makes a few
         // hundredths of difference.
         {Preconditioner::automatic, Preconditioner::multigrid, Preconditioner::stencil_block,
          Preconditioner::constrained_block, Preconditioner::none}) {
        problem.solve({kind, 1e-3, 2000}, 1);
        CHECK(folded.residual(folded.unknowns(problem.solution())) <= 1.1e-3);
    }
    problem.solve({Preconditioner::constrained_block, 1e-10, 2000}, 1);
    const Eigen::VectorXd ours = folded.unknowns(problem.solution());
    CHECK((ours - exact.y).lpNorm<Eigen::Infinity>() <= 1e-8 * exact.y.lpNorm<Eigen::Infinity>());

    const PeerSolve iterated = solve_by_eigen_cg(folded, 1e-10, 2000);
    CHECK(iterated.iterations > 0);
    CHECK((iterated.y - exact.y).lpNorm<Eigen::Infinity>() <= 1e-8 * exact.y.lpNorm<Eigen::Infinity>());
    if (const std::optional<PeerSolve> direct = solve_by_cholmod(folded)) {
        CHECK((direct->y - exact.y).lpNorm<Eigen::Infinity>() <= 1e-9 * exact.y.lpNorm<Eigen::Infinity>());
    } else {
        CHECK_FALSE(cholmod_missing().empty());
    }
}

TEST_CASE("the largest component alone is solved as among the others", "[bench]") {
    MeasuredProblem problem(testing::drape(), 0.4, 1);
    problem.capture(1);
    const SolveOptions options{Preconditioner::constrained_block, 1e-6, 2000};
    const MeasuredProblem::Solve all = problem.solve(options, 1);
    std::size_t largest = 0;
    for (std::size_t c = 0; c < problem.components().count(); ++c)
        if (problem.components().size(c) > problem.components().size(largest)) largest = c;
    const ComponentSolve among = problem.solves()[largest];
    const MeasuredProblem::Solve alone = problem.solve_largest(options, 1);
    CHECK(alone.rvm == among.rvm);
    CHECK(alone.iterations == among.iterations);
    CHECK(alone.rvm <= all.rvm);
}

TEST_CASE("a tiny bench leaves tables, plots, and records as their schema says", "[bench]") {
    const TemporaryFolder folder;
    const std::filesystem::path made = folder / "bench";
    REQUIRE(run_command_line({"bench", UNRAVEL_SOURCE_DIR "/scenes/hang.toml", "--set", "clip.duration=0.08",
                              "-o", made.string(), "--sizes", "100,400", "--budget", "0.5", "--threads", "2",
                              "--quiet"}) == exit_done);
    for (const char* name :
         {"bench.json", "bench.md", "summary.md", "bench.svg", "bench.png", "details.svg", "details.png"})
        CHECK(std::filesystem::file_size(made / name) > 100);

    const auto schema = nlohmann::json::parse(page_file("bench.schema.json"));
    const nlohmann::json record = json_of(made / "bench.json");
    CHECK(valid(record, schema));
    for (const auto& key : schema["required"]) {
        nlohmann::json without = record;
        without.erase(key.get<std::string>());
        CHECK_FALSE(valid(without, schema));
    }
    nlohmann::json odd = record;
    odd["sizes"][0]["solves"][0]["seconds"]["median"] = "fast";
    CHECK_FALSE(valid(odd, schema));

    REQUIRE(record["sizes"].size() == 2);
    CHECK(record["sizes"][1]["particles"] == 400);
    CHECK(record["exponents"]["step"].is_number());
    for (const auto& size : record["sizes"]) {
        for (const auto& step : size["steps"]) CHECK(step["seconds"]["runs"] > 0);
        for (const auto& solve : size["solves"]) {
            if (!solve.contains("left_out")) CHECK(solve["residual"] <= 1e-2);
        }
        CHECK(size["account"]["speed_up"]["64"] >= 1.0);
    }
}
