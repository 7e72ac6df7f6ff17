#pragma once

// The files that a scene's meshes come from.

#include <functional>
#include <optional>

#include "sim/mesh/mesh_solid.hpp"
#include "sim/scene_file/diagnostics.hpp"

namespace unravel::sim {

/// Reads them from the scene's root, tells what is wrong at the places that name them, and adds what was
/// mended to the scene's notes. `path`: of the key that names a file; `hash`: of the content read so far.
class MeshFiles {
public:
    MeshFiles(Scene& scene, const Places& places, std::vector<SceneProblem>& problems)
        : scene_(scene), places_(places), problems_(problems) {}

    void problem(const std::string& path, std::string what, std::string hint) const {
        problems_.push_back({places_.at(path), std::move(what), std::move(hint)});
    }
    void note(const std::string& text) const { scene_.notes.push_back(text); }
    const Places& places() const { return places_; }

    /// The mesh as the scene takes it: the part that is meant, mended in what cloth and bodies share, `merge`
    /// among it, and then by `judge`, which also tells what keeps it from being used. `animation` of its file
    /// (or empty) gives the `figure` that poses it.
    std::optional<PolygonMesh> read_mesh(const MeshFile& file, const std::string& path, bool merge,
                                         std::uint64_t& hash,
                                         const std::function<void(PolygonMesh&, MeshMessages&)>& judge,
                                         const std::string& animation,
                                         std::shared_ptr<const Figure>& figure) const;

    /// How a body of `points` vertices in its file deforms: a point cache, or a sequence of OBJ files.
    void read_samples(const std::string& name, const std::string& path, std::size_t points, MeshSolid& body,
                      std::uint64_t& hash) const;

    /// A run's scene names the content that it was made with; any other scene takes what is there. False: it
    /// has changed.
    bool tie(MeshFile& mesh, const std::string& path, std::uint64_t hash) const;

    /// "did you mean", or some of the names there are; `what` where there are none.
    static std::string other_names(const std::string& name, std::vector<std::string_view> names,
                                   std::string what);

private:
    bool report(const std::string& path, const std::string& file, const MeshMessages& said) const;
    bool read(const std::string& path, const std::string& name, std::vector<std::uint8_t>& bytes,
              std::uint64_t& hash) const;
    bool keep_named(PolygonMesh& mesh, const MeshFile& file, const std::string& path) const;
    void read_sequence(const std::string& name, const std::string& path, std::size_t points, MeshSolid& body,
                       std::uint64_t& hash) const;

    Scene& scene_;
    const Places& places_;
    std::vector<SceneProblem>& problems_;
};

}  // namespace unravel::sim
