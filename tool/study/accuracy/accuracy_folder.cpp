#include "tool/study/accuracy/accuracy_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/whole_file.hpp"
#include "sim/scene_file/load.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_csv = std::size_t{1} << 26;

std::size_t particles_of(const Scene& scene) {
    std::size_t particles = 0;
    for (const Cloth& cloth : scene.cloths)
        particles +=
            static_cast<std::size_t>(cloth.particles[0]) * static_cast<std::size_t>(cloth.particles[1]);
    return particles;
}

// Of two timings of a point the one with more runs counts.
void add_points(const fs::path& csv, std::vector<AccuracyPoint>& points) {
    for (AccuracyPoint& point : read_accuracy_csv(read_whole_text(csv, largest_csv))) {
        const auto known = std::find_if(points.begin(), points.end(),
                                        [&](const AccuracyPoint& p) { return p.setting == point.setting; });
        if (known == points.end()) {
            points.push_back(std::move(point));
        } else if (point.seconds.size() >= known->seconds.size()) {
            *known = std::move(point);
        }
    }
}

}  // namespace

const AccuracyPoint* AccuracyStudy::find(const AccuracySetting& setting) const {
    const auto found = std::find_if(points.begin(), points.end(),
                                    [&](const AccuracyPoint& p) { return p.setting == setting; });
    return found == points.end() ? nullptr : &*found;
}

AccuracyFolder::AccuracyFolder(const Scene& scene, const fs::path& folder, bool force)
    : scene_(scene), folder_(folder) {
    const fs::path toml = folder_ / "scene.toml";
    holds_study_ = !force && fs::exists(toml) && fs::exists(reference()) &&
                   read_whole_text(toml, largest_csv) == scene_to_toml(scene);
}

AccuracyStudy AccuracyFolder::read() const {
    AccuracyStudy study;
    study.scene = scene_;
    study.reference = read_reference(reference(), particles_of(scene_));
    if (fs::exists(csv())) add_points(csv(), study.points);
    std::set<fs::path> files;  // in the order of their names, whatever that of the folder
    if (fs::exists(points())) {
        for (const auto& entry : fs::directory_iterator(points())) {
            if (entry.is_regular_file() && entry.path().extension() == ".csv") files.insert(entry.path());
        }
    }
    for (const fs::path& file : files) add_points(file, study.points);
    return study;
}

void AccuracyFolder::begin() const {
    fs::create_directories(folder_);
    if (!holds_study_) {
        fs::remove(csv());
        fs::remove(reference());
        fs::remove_all(points());
    }
    write_whole_file(folder_ / "scene.toml", scene_to_toml(scene_));
}

void AccuracyFolder::save_reference(const AccuracyReference& computed) const {
    write_whole_file(reference(), reference_bytes(computed));
}

void AccuracyFolder::save_points(const std::vector<AccuracyPoint>& all) const {
    write_whole_file(csv(), accuracy_csv(all));
}

void AccuracyFolder::save_point(const AccuracyPoint& point) const {
    fs::create_directories(points());
    write_whole_file(point_file(point.setting), accuracy_csv({point}));
}

fs::path AccuracyFolder::point_file(const AccuracySetting& s) const {
    return points() / fmt::format("{}_{}_{}_{}_{}_{}_{}.csv", integrator_name(s.integrator),
                                  s.steps_per_frame, s.threshold, s.tolerance, static_cast<int>(s.activation),
                                  s.band, static_cast<int>(s.bend));
}

}  // namespace unravel::tool
