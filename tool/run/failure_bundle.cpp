#include "tool/run/failure_bundle.hpp"

#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "render/png.hpp"
#include "render/renderer.hpp"
#include "sim/scene_file/load.hpp"
#include "tool/picture/view.hpp"

namespace unravel::tool {

namespace {

using Json = nlohmann::ordered_json;

constexpr Rgb marked{230, 60, 40}, unmarked{150, 155, 165};

Json vector_json(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

Json failure_json(const Simulation& simulation, const SimulationError& error) {
    const StepFailure& f = error.failure();
    Json json{{"what", error.what()},
              {"criterion", criterion_name(f.criterion)},
              {"step", f.step},
              {"t", f.t},
              {"h", f.h},
              {"frame", simulation.frame + 1},
              {"value", f.value},
              {"limit", f.limit},
              {"advice", f.advice}};
    json["particles"] = Json::array();
    for (const std::uint32_t p : f.particles) {
        json["particles"].push_back({{"particle", p},
                                     {"mass", simulation.model.mass[p]},
                                     {"x", vector_json(simulation.state.x[p])},
                                     {"v", vector_json(simulation.state.v[p])}});
    }
    if (f.spring) {
        const ExtensionSprings& s = simulation.model.springs;
        const std::uint32_t k = *f.spring;
        json["spring"] = {{"i", s.i[k]},
                          {"j", s.j[k]},
                          {"rest", s.rest[k]},
                          {"stiffness", s.stiffness[k]},
                          {"damping", s.damping[k]},
                          {"length", (simulation.state.x[s.j[k]] - simulation.state.x[s.i[k]]).norm()}};
    }
    return json;
}

Image picture_of_worst(const Scene& scene, const Simulation& simulation, const FrameRecord& record,
                       const StepFailure& failure, const ClipOptions& options) {
    Placement placement;
    build_model(scene, placement);
    const DrawScene drawn = make_draw_scene(scene, simulation.model, placement);
    std::vector<Rgb> colors(simulation.model.size(), unmarked);
    for (const std::uint32_t p : failure.particles) colors[p] = marked;
    DrawFrame frame;
    make_draw_frame(scene, simulation.model, drawn, record, colors, frame);
    const GlContext context(options.device);
    Renderer renderer(context, drawn,
                      {scene.clip.size[0], scene.clip.size[1], options.samples, options.supersample});
    Image image;
    renderer.draw(DrawStyle::components, frame, image);
    return image;
}

}  // namespace

void write_failure(const RunFolder& folder, const Scene& scene, std::uint64_t scene_hash,
                   const Simulation& simulation, const SimulationError& error, const ClipOptions& options) {
    std::error_code failed;
    std::filesystem::create_directories(folder.failure(), failed);
    if (failed) throw OutputError(folder.failure(), failed.value());
    const FrameRecord record = present_record(simulation);
    write_whole_file(folder.failure() / "failure.json", failure_json(simulation, error).dump(2) + "\n");
    copy_named_files(folder.failure(), scene, folder.root);
    write_whole_file(folder.failure() / "scene.toml", scene_to_toml(scene));
    write_record(folder.failure() / "last_good.state", scene_hash, record);
    try {
        write_png(folder.failure() / "worst.png",
                  picture_of_worst(scene, simulation, record, error.failure(), options));
    } catch (const RendererError&) {
        // `simulate` runs on machines that draw nothing; numbers and state are there.
    }
}

}  // namespace unravel::tool
