// Figures for a page.
#include "tool/picture/figure.hpp"

#include <catch2/catch.hpp>
#include <fstream>

#include "render/palette.hpp"
#include "tests/base/temporary_folder.hpp"
#include "tests/sim/scenes.hpp"
#include "tool/picture/vector_still.hpp"
#include "tool/picture/view.hpp"
#include "tool/picture/wire_colors.hpp"

using namespace unravel;
using namespace unravel::tool;

namespace {

/// A flat sheet seen from straight above, half of it one component and half another, a corner held; with a
/// ball above it or below.
struct Flat {
    static constexpr int n = 11;
    Scene scene = testing::drape(n);
    Simulation simulation;
    DrawScene drawn;
    FrameRecord record;
    DrawFrame frame;

    explicit Flat(double ball = -5) {
        scene.solids[0].center = {0.2, 0.95 + ball, 0.2};
        scene.solids[0].pivot = scene.solids[0].center;
        scene.solids[0].radius = 0.1;
        scene.clip.size = {400, 400};
        scene.cameras[0].position = {0, 3, 1e-3};
        scene.cameras[0].target = {0, 0.95, 0};
        scene.cameras[0].fov = 32;
        simulation = start_simulation(scene);
        record = present_record(simulation);
        std::vector<Rgb> colors;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const auto p = static_cast<std::size_t>(j * n + i);
                const bool held = i == 0 && j == 0;
                record.component[p] = held ? -1 : i < n / 2 ? 0 : 1;
                record.free[p] = held ? 0 : 3;
                colors.push_back(held ? constrained_color : component_palette[i < n / 2 ? 1 : 2]);
            }
        for (SpringState& state : record.springs) state = SpringState::implicit;
        Placement placement;
        build_model(scene, placement);
        drawn = make_draw_scene(scene, simulation.model, placement);
        make_draw_frame(scene, simulation.model, drawn, record, colors, frame);
    }
    Image picture() const {
        return figure_picture(PaperFigure(scene, simulation.model, drawn), record, frame, 400, 400);
    }
    /// Where a particle, or a place between particles, is in the picture.
    std::array<int, 2> at(double i, double j) const {
        const PageView view(frame.camera, 400, 400);
        const PagePoint p =
            view(Vec3f(static_cast<float>(i / (n - 1) - 0.5), 0.95f, static_cast<float>(j / (n - 1) - 0.5)));
        return {static_cast<int>(p.x), static_cast<int>(p.y)};
    }
};

int lightness(const Image& image, std::array<int, 2> at) {
    const std::uint8_t* p = image.at(at[0], at[1]);
    return (p[0] + p[1] + p[2]) / 3;
}

/// How far a pixel's colour is from grey.
int chroma(const Image& image, std::array<int, 2> at) {
    const std::uint8_t* p = image.at(at[0], at[1]);
    return std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]});
}

int count(const std::string& text, const std::string& word) {
    int found = 0;
    for (std::size_t k = text.find(word); k != text.npos; k = text.find(word, k + word.size())) ++found;
    return found;
}

}  // namespace

TEST_CASE("a_figure_shows_particles_as_dots_and_held_ones_as_open_circles_on_white") {
    const Flat flat;
    const Image image = flat.picture();
    CHECK(lightness(image, {2, 2}) == 255);  // the page
    CHECK(lightness(image, flat.at(0, 0)) > 240);
    CHECK(lightness(image, flat.at(3, 4)) < 120);
    CHECK(lightness(image, flat.at(3.5, 4.5)) > 140);
    // Around the open circle is a dark ring.
    const auto [x, y] = flat.at(0, 0);
    int darkest = 255;
    for (int r = -5; r <= 5; ++r) darkest = std::min(darkest, lightness(image, {x + r, y}));
    CHECK(darkest < 130);
}

TEST_CASE("cells_of_a_figure_are_crisply_of_one_component") {
    const Flat flat;
    const Image image = flat.picture();
    const auto color = [&](double i, double j) {
        const auto [x, y] = flat.at(i, j);
        const std::uint8_t* p = image.at(x, y);
        return Rgb{p[0], p[1], p[2]};
    };
    CHECK(color(1.5, 5.5) == color(3.5, 7.5));
    CHECK(color(6.5, 5.5) == color(8.5, 2.5));
    CHECK_FALSE(color(3.5, 5.5) == color(6.5, 5.5));
    CHECK(chroma(image, flat.at(3.5, 5.5)) > 20);
    CHECK(chroma(image, flat.at(4.5, 5.5)) < 12);  // between the two: nobody's
}

TEST_CASE("a_figure_hides_what_lies_behind_a_solid_and_shows_what_lies_before_it") {
    const Flat above(0.4), below(-0.4);
    // Through the middle of the ball, which is at (7, 7); moved a little towards the viewer by its height.
    const std::array<int, 2> place = below.at(7.4, 7.4);
    CHECK(chroma(below.picture(), place) > 20);
    CHECK(chroma(above.picture(), above.at(7.9, 7.9)) < 12);
}

TEST_CASE("a_dense_figure_has_outlines_of_components_in_place_of_wires") {
    Flat flat;
    flat.drawn.solids.clear();
    flat.frame.camera.position = {0, 200, 0.02f};  // less than a pixel between particles
    const PaperFigure figure(flat.scene, flat.simulation.model, flat.drawn);
    const std::string svg =
        canvas_svg(400, 400, [&](Canvas& canvas) { figure.draw(canvas, flat.record, flat.frame, 400, 400); });
    // 100 cells, no dots; sides where the cloth ends (40) and between cells of two colours and of neither
    // (2 × 10), and around the held corner's cell none, whose free corners agree.
    CHECK(count(svg, "fill-rule") == 100);
    CHECK(count(svg, "stroke-width=\"0.9\"") + count(svg, "stroke-width:0.9") == 40);
    CHECK(count(svg, "stroke-width=\"0.6\"") + count(svg, "stroke-width:0.6") == 120);
}

TEST_CASE("vector_stills_are_of_the_size_asked_and_the_same_each_time") {
    const Flat flat;
    const TemporaryFolder folder;
    Scene scene = flat.scene;
    scene.look.legend = true;
    Placement placement;
    const ClothModel model = build_model(scene, placement);
    ClipOptions options;
    options.views = {{Layout::components, 0, "components"}};
    const RunFolder files{folder.path()};
    std::filesystem::create_directories(files.frames());
    for (const char* format : {"svg", "pdf"}) {
        options.format = format;
        const auto write = [&] {
            const auto file = write_vector_still(scene, model, placement, files, options,
                                                 [&](int) { return FrameRecord(flat.record); });
            CHECK(file.filename() == std::string("components_0000.") + format);
            std::ifstream stream(file, std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(stream), {});
        };
        const std::string text = write();
        CHECK(text == write());
        if (options.format == "pdf")
            CHECK(text.starts_with("%PDF"));
        else
            CHECK(text.find("viewBox=\"0 0 400 400\"") != text.npos);
    }
}

TEST_CASE("a_scale_ends_above_99_of_a_hundred_values") {
    const Flat flat;
    ClothState state = flat.record.state;
    for (std::size_t p = 0; p < state.v.size(); ++p) state.v[p] = Vec3(0.001 * (p % 100 + 1), 0, 0);
    ScaleFinder finder;
    CHECK(finder.end() == 0);
    finder.add(Show::velocity, flat.simulation.model, state);
    CHECK(finder.end() == Approx(0.1));  // 0.099 m/s, rounded up
    for (Vec3& v : state.v) v *= 0.01;
    for (int k = 0; k < 200; ++k) finder.add(Show::velocity, flat.simulation.model, state);
    CHECK(finder.end() == Approx(0.001));  // one frame of 201 is less than a hundredth
}
