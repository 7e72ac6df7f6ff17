// The meshes of a scene: read, checked, and tied to the scene by their hash.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "sim/mesh/check_mesh.hpp"
#include "sim/mesh/mesh_cloth.hpp"
#include "sim/mesh/mesh_solid.hpp"
#include "sim/mesh/pc2.hpp"
#include "sim/mesh/placement.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/similar.hpp"

namespace unravel::sim {

namespace {

namespace fs = std::filesystem;

class MeshLoader {
public:
    MeshLoader(const Places& places, std::vector<SceneProblem>& problems, const fs::path& folder)
        : places_(places), problems_(problems), folder_(folder) {}

    void load(Cloth& cloth, const std::string& path) {
        const std::size_t before = problems_.size();
        ObjMesh mesh;
        std::uint64_t hash = 14695981039346656037ull;
        if (!read_obj(path + ".mesh", cloth.mesh.file, mesh, hash)) return;
        std::vector<MeshFault> faults;
        check_cloth_mesh(mesh, faults, max_faults);
        report(path + ".mesh", cloth.mesh.file, faults);
        if (problems_.size() > before || !tie(cloth.mesh, path, hash)) return;
        cloth.geometry =
            std::make_shared<MeshCloth>(make_mesh_cloth(std::move(mesh), cloth.mesh.scale, cloth.mesh.up));
        cloth.particles = {static_cast<int>(cloth.geometry->rest.size()), 1};
        const Vec3 extent = cloth.geometry->extent();
        cloth.size = {extent.maxCoeff(), extent.sum() - extent.maxCoeff() - extent.minCoeff()};
        check_groups(cloth, path);
    }

    void load(Solid& solid, const std::string& path) {
        const std::size_t before = problems_.size();
        ObjMesh mesh;
        std::uint64_t hash = 14695981039346656037ull;
        if (!read_obj(path + ".mesh", solid.mesh.file, mesh, hash)) return;
        std::vector<MeshFault> faults;
        check_solid_mesh(mesh, faults, max_faults);
        report(path + ".mesh", solid.mesh.file, faults);
        if (problems_.size() > before) return;
        MeshSolid body;
        body.rest = std::move(mesh.positions);
        body.triangles = triangles_of(body.rest, mesh.faces);
        if (!solid.frames.files.empty()) {
            body.fps = solid.frames.fps;
            body.start = solid.frames.start;
            load_samples(solid.frames.files, path + ".mesh_frames", body, hash);
        }
        if (problems_.size() > before || !tie(solid.mesh, path, hash)) return;
        const auto place = [&](Vec3& x) {
            x = from_file(x, solid.mesh.scale, solid.mesh.up);
            body.reach = std::max(body.reach, x.norm());
        };
        for (Vec3& x : body.rest) place(x);
        for (std::vector<Vec3>& sample : body.samples) {
            for (Vec3& x : sample) place(x);
        }
        if (body.deforms()) {
            const std::vector<Vec3> undeformed = std::move(body.rest);
            body.positions_at(0, body.rest);
        }
        body.tree = MeshTree(body.rest, body.triangles);
        solid.geometry = std::make_shared<MeshSolid>(std::move(body));
    }

private:
    void problem(const std::string& path, std::string what, std::string hint) {
        problems_.push_back({places_.at(path), std::move(what), std::move(hint)});
    }

    void report(const std::string& path, const std::string& file, const std::vector<MeshFault>& faults) {
        for (const MeshFault& fault : faults) {
            const std::string where =
                fault.line > 0 ? fmt::format("{}:{}", file, fault.line) : std::string(file);
            problem(path, fmt::format("{}: {}", where, fault.what), fault.hint);
        }
        if (faults.size() == max_faults)
            problem(path, fmt::format("{} may have more faults than these", file), "mend them first");
    }

    // Bytes of a file in the scene's folder, added to the hash; false with a problem.
    bool read(const std::string& path, const std::string& name, std::vector<std::uint8_t>& bytes,
              std::uint64_t& hash) {
        const ContainedFile found = contained_file(folder_, name, "mesh");
        if (!found.what.empty()) {
            problem(path, found.what, found.hint);
            return false;
        }
        try {
            bytes = read_whole_file(found.file, max_mesh_bytes);
        } catch (const InputError& error) {
            problem(path, error.what(), "");
            return false;
        }
        hash = hash_bytes(bytes.data(), bytes.size(), hash);
        return true;
    }

    bool read_obj(const std::string& path, const std::string& name, ObjMesh& mesh, std::uint64_t& hash) {
        std::vector<std::uint8_t> bytes;
        if (!read(path, name, bytes, hash)) return false;
        std::vector<MeshFault> faults;
        mesh = parse_obj({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, faults, max_faults);
        report(path, name, faults);
        return faults.empty();
    }

    // A run's scene names the content that it was made with; any other scene takes what is there.
    bool tie(MeshFile& mesh, const std::string& path, std::uint64_t hash) {
        const std::string now = fmt::format("{:016x}", hash);
        if (!mesh.hash.empty() && mesh.hash != now) {
            problem(path + ".mesh_hash", fmt::format("the mesh \"{}\" has changed", mesh.file),
                    "put back the file that the run was made with, or remove this line to take the new one");
            return false;
        }
        mesh.hash = now;
        return true;
    }

    // Quads are cut along the shorter diagonal.
    static std::vector<std::array<std::uint32_t, 3>> triangles_of(const std::vector<Vec3>& x,
                                                                  const std::vector<ObjMesh::Face>& faces) {
        std::vector<std::array<std::uint32_t, 3>> out;
        for (const ObjMesh::Face& face : faces) {
            const auto& [a, b, c, d] = face.vertex;
            if (face.corners == 3) {
                out.push_back({a, b, c});
            } else if ((x[a] - x[c]).squaredNorm() <= (x[b] - x[d]).squaredNorm()) {
                out.push_back({a, b, c});
                out.push_back({a, c, d});
            } else {
                out.push_back({a, b, d});
                out.push_back({b, c, d});
            }
        }
        return out;
    }

    void load_samples(const std::string& name, const std::string& path, MeshSolid& body,
                      std::uint64_t& hash) {
        if (name.find('#') != std::string::npos) {
            load_sequence(name, path, body, hash);
            return;
        }
        std::vector<std::uint8_t> bytes;
        if (!read(path, name, bytes, hash)) return;
        Pc2Header header;
        const std::string wrong = read_pc2(bytes, body.rest.size(), max_sample_bytes, header, body.samples);
        if (!wrong.empty())
            problem(path, fmt::format("{}: {}", name, wrong), "bake the cache anew from this mesh");
        body.sample_files = {name};
    }

    void load_sequence(const std::string& name, const std::string& path, MeshSolid& body,
                       std::uint64_t& hash) {
        const std::size_t first = name.find('#'), last = name.find_first_not_of('#', first);
        const std::size_t digits = (last == std::string::npos ? name.size() : last) - first;
        const auto numbered = [&](int k) {
            return fmt::format("{}{:0{}}{}", name.substr(0, first), k, digits, name.substr(first + digits));
        };
        std::error_code error;
        int number = fs::exists(folder_ / numbered(0), error) ? 0 : 1;
        for (; number <= max_frames; ++number) {
            const std::string file = numbered(number);
            // The first must be there; the sequence ends before the first that is not.
            if (!body.samples.empty() && !fs::exists(folder_ / file, error)) return;
            ObjMesh mesh;
            if (!read_obj(path, file, mesh, hash)) return;
            if (mesh.positions.size() != body.rest.size()) {
                problem(path,
                        fmt::format("{}: it has {} vertices, the mesh {}", file, mesh.positions.size(),
                                    body.rest.size()),
                        "every file of a sequence is the same mesh, moved");
                return;
            }
            if ((body.samples.size() + 1) * body.rest.size() * sizeof(Vec3) > max_sample_bytes) {
                problem(path, fmt::format("{}: the samples are more than a run can hold", file), "");
                return;
            }
            body.samples.push_back(std::move(mesh.positions));
            body.sample_files.push_back(file);
        }
    }

    void check_group(const Cloth& cloth, const std::string& path, const std::string& group) {
        const auto& groups = cloth.geometry->groups;
        if (groups.contains(group)) return;
        std::vector<std::string_view> names;
        for (const auto& [name, vertices] : groups) names.push_back(name);
        const std::string_view near = most_similar(group, names);
        std::string hint = "the mesh has no groups (g lines)";
        if (!near.empty()) {
            hint = fmt::format("did you mean \"{}\"?", near);
        } else if (!names.empty()) {
            names.resize(std::min<std::size_t>(names.size(), 12));
            hint = fmt::format("it has {}", fmt::join(names, ", "));
        }
        problem(path, fmt::format("the mesh has no group \"{}\"", group), hint);
    }

    void check_groups(const Cloth& cloth, const std::string& path) {
        for (std::size_t k = 0; k < cloth.regions.size(); ++k) {
            if (!cloth.regions[k].group.empty())
                check_group(cloth, fmt::format("{}.region[{}].group", path, k), cloth.regions[k].group);
        }
        for (std::size_t k = 0; k < cloth.pins.size(); ++k) {
            const Pin& pin = cloth.pins[k];
            const std::string at = fmt::format("{}.pin[{}].", path, k);
            if (pin.target == PinTarget::group) check_group(cloth, at + "group", pin.group);
            if (pin.target == PinTarget::within && places_.sound(at + "within") &&
                pinned_particles(cloth, pin).empty())
                problem(at + "within", "the pin catches no particle", "no vertex starts in this box");
        }
    }

    const Places& places_;
    std::vector<SceneProblem>& problems_;
    const fs::path& folder_;
};

}  // namespace

void load_meshes(Scene& scene, const Places& places, std::vector<SceneProblem>& problems,
                 const fs::path& folder) {
    const fs::path home = folder.empty() ? fs::path(".") : folder;
    MeshLoader loader(places, problems, home);
    const auto load = [&](auto& things, const char* kind) {
        for (std::size_t i = 0; i < things.size(); ++i) {
            const std::string path = fmt::format("{}[{}]", kind, i);
            if (!things[i].mesh.file.empty() && places.sound(path + ".mesh")) loader.load(things[i], path);
        }
    };
    load(scene.cloths, "cloth");
    load(scene.solids, "solid");
}

}  // namespace unravel::sim
