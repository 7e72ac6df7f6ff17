#include "sim/scene_file/mesh_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "sim/mesh/pc2.hpp"
#include "sim/mesh/read_mesh.hpp"
#include "sim/mesh/repair.hpp"
#include "sim/scene/limits.hpp"
#include "sim/scene_file/check.hpp"
#include "sim/scene_file/similar.hpp"

namespace unravel::sim {

namespace fs = std::filesystem;

std::string MeshFiles::other_names(const std::string& name, std::vector<std::string_view> names,
                                   std::string what) {
    const std::string_view near = most_similar(name, names);
    if (!near.empty()) return fmt::format("did you mean \"{}\"?", near);
    if (names.empty()) return what;
    names.resize(std::min<std::size_t>(names.size(), 12));
    return fmt::format("it has {}", fmt::join(names, ", "));
}

// False: it has faults.
bool MeshFiles::report(const std::string& path, const std::string& file, const MeshMessages& said) const {
    for (const std::string& told : said.notes) note(fmt::format("{}: {}", file, told));
    for (const MeshFault& fault : said.faults) {
        const std::string where = fault.line > 0 ? fmt::format("{}:{}", file, fault.line) : file;
        problem(path, fmt::format("{}: {}", where, fault.what), fault.hint);
    }
    if (said.full())
        problem(path, fmt::format("{} may have more faults than these", file), "mend them first");
    return said.faults.empty();
}

bool MeshFiles::read(const std::string& path, const std::string& name, std::vector<std::uint8_t>& bytes,
                     std::uint64_t& hash) const {
    const ContainedFile found = contained_file(scene_.home, name, "mesh");
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

bool MeshFiles::keep_named(PolygonMesh& mesh, const MeshFile& file, const std::string& path) const {
    std::set<std::string_view> objects, groups;
    const std::vector<PolygonMesh::Part> parts = mesh.parts;
    for (const PolygonMesh::Part& part : parts) {
        objects.insert(part.objects.begin(), part.objects.end());
        groups.insert(part.groups.begin(), part.groups.end());
    }
    const auto known = [&](const std::set<std::string_view>& names, const std::string& name,
                           const char* kind) {
        if (name.empty() || names.contains(name)) return true;
        problem(fmt::format("{}_{}", path, kind), fmt::format("{} has no {} \"{}\"", file.file, kind, name),
                other_names(name, {names.begin(), names.end()}, fmt::format("it has no {}s at all", kind)));
        return false;
    };
    if (!known(objects, file.object, "object") || !known(groups, file.group, "group")) return false;
    if (keep_part(mesh, file.object, file.group)) return true;
    problem(path, fmt::format("no face of {} is in \"{}\" and \"{}\"", file.file, file.object, file.group),
            "say one of mesh_object and mesh_group");
    return false;
}

std::optional<PolygonMesh> MeshFiles::read_mesh(const MeshFile& file, const std::string& path, bool merge,
                                                std::uint64_t& hash,
                                                const std::function<void(PolygonMesh&, MeshMessages&)>& judge,
                                                const std::string& animation,
                                                std::shared_ptr<const Figure>& figure) const {
    std::vector<std::uint8_t> bytes;
    if (!read(path, file.file, bytes, hash)) return {};
    MeshMessages said;
    said.most = max_faults;
    PolygonMesh mesh = parse_mesh(file.file, bytes, said, animation, figure);
    bytes = {};
    const bool part = !file.object.empty() || !file.group.empty();
    if (said.faults.empty() && part && !keep_named(mesh, file, path)) return {};
    if (said.faults.empty()) {
        if (merge) merge_coincident(mesh, said);
        drop_flat_faces(mesh, said);
        drop_unused_vertices(mesh, said);
        turn_alike(mesh, said);
        judge(mesh, said);
    }
    if (!report(path, file.file, said)) return {};
    return mesh;
}

bool MeshFiles::tie(MeshFile& mesh, const std::string& path, std::uint64_t hash) const {
    const std::string now = fmt::format("{:016x}", hash);
    if (!mesh.hash.empty() && mesh.hash != now) {
        problem(path + ".mesh_hash", fmt::format("the mesh \"{}\" has changed", mesh.file),
                "put back the file that the run was made with, or remove this line to take the new one");
        return false;
    }
    mesh.hash = now;
    return true;
}

void MeshFiles::read_samples(const std::string& name, const std::string& path, std::size_t points,
                             MeshSolid& body, std::uint64_t& hash) const {
    if (name.find('#') != std::string::npos) {
        read_sequence(name, path, points, body, hash);
        return;
    }
    std::vector<std::uint8_t> bytes;
    if (!read(path, name, bytes, hash)) return;
    Pc2Header header;
    const std::string wrong = read_pc2(bytes, points, max_sample_bytes, header, body.samples);
    if (!wrong.empty())
        problem(path, fmt::format("{}: {}", name, wrong), "bake the cache anew from this mesh");
    body.sample_files = {name};
}

void MeshFiles::read_sequence(const std::string& name, const std::string& path, std::size_t points,
                              MeshSolid& body, std::uint64_t& hash) const {
    const std::size_t first = name.find('#'), last = name.find_first_not_of('#', first);
    const std::size_t digits = (last == std::string::npos ? name.size() : last) - first;
    const auto numbered = [&](int k) {
        return fmt::format("{}{:0{}}{}", name.substr(0, first), k, digits, name.substr(first + digits));
    };
    std::error_code error;
    int number = fs::exists(scene_.home / numbered(0), error) ? 0 : 1;
    for (; number <= max_frames; ++number) {
        const std::string file = numbered(number);
        // The first must be there; the sequence ends before the first that is not.
        if (!body.samples.empty() && !fs::exists(scene_.home / file, error)) return;
        std::vector<std::uint8_t> bytes;
        if (!read(path, file, bytes, hash)) return;
        MeshMessages said;
        std::shared_ptr<const Figure> none;
        PolygonMesh mesh = parse_mesh(file, bytes, said, {}, none);
        said.notes.clear();  // the same in all of them, and told of the mesh itself
        if (!report(path, file, said)) return;
        if (mesh.positions.size() != points) {
            problem(path,
                    fmt::format("{}: it has {} vertices, the mesh {}", file, mesh.positions.size(), points),
                    "every file of a sequence is the same mesh, moved");
            return;
        }
        if ((body.samples.size() + 1) * points * sizeof(Vec3) > max_sample_bytes) {
            problem(path, fmt::format("{}: the samples are more than a run can hold", file), "");
            return;
        }
        body.samples.push_back(std::move(mesh.positions));
        body.sample_files.push_back(file);
    }
}

}  // namespace unravel::sim
