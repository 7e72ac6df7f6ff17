#include "render/cloth_renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/coarse_mesh.hpp"
#include "render/color.hpp"
#include "render/normals.hpp"
#include "render/picture_texture.hpp"
#include "render/shadow.hpp"

namespace unravel::render {

namespace {

// Triangles of a cloth from which on a software renderer works its light out at its vertices: they are a few
// pixels large then, and cost it as much each as blocks of pixels do.
constexpr std::size_t fine_mesh = 60'000;

// Particles of a cloth that cast its shadow: a software renderer takes more for every triangle than a pixel
// of shadow is worth.
constexpr std::size_t key_casters = 30'000, sky_casters = 1'600;

/// Between neighbouring vertices, where cells are square [m].
float vertex_gap(const ClothMesh& mesh) {
    float twice_area = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec2f p = mesh.uv[b] - mesh.uv[a], q = mesh.uv[c] - mesh.uv[a];
        twice_area += std::abs(p.x() * q.y() - p.y() * q.x());
    }
    return std::sqrt(twice_area / static_cast<float>(std::max<std::size_t>(mesh.triangles.size(), 1)));
}

/// Cells along the side of a block of triangles.
constexpr float block_cells = 13;

/// The mesh's triangles, block after block of the flat cloth. Renderers take triangles by batches and work
/// out each vertex once for a batch: rows of a wide cloth share less than blocks do.
std::vector<std::array<std::uint32_t, 3>> in_blocks(const ClothMesh& mesh) {
    const float side = std::max(block_cells * vertex_gap(mesh), 1e-6f);
    const auto block = [&](const std::array<std::uint32_t, 3>& corners) {
        const Vec2f middle = (mesh.uv[corners[0]] + mesh.uv[corners[1]] + mesh.uv[corners[2]]) / 3;
        return std::pair(std::floor(middle.y() / side), std::floor(middle.x() / side));
    };
    std::vector<std::array<std::uint32_t, 3>> triangles = mesh.triangles;
    std::ranges::stable_sort(triangles, {}, block);
    return triangles;
}

Vec3f mix(const Vec3f& a, const Vec3f& b, float t) {
    return a + t * (b - a);
}

/// Mean colour of a weave of two yarns.
Vec3f mean_of(WeavePattern weave, const std::array<Vec3f, 2>& yarn) {
    return mix(yarn[0], yarn[1],
               weave == WeavePattern::solid   ? 0
               : weave == WeavePattern::plain ? 0.11f
                                              : 0.5f);
}

/// Mean colour of a picture, in linear light.
Vec3f mean_of(const Image& image) {
    Vec3f sum = Vec3f::Zero();
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const std::uint8_t* p = image.at(x, y);
            sum += linear({p[0], p[1], p[2]});
        }
    return sum / static_cast<float>(std::max(image.width * image.height, 1));
}

// Pixels a thread from which on it is seen; see weave.glsl.
constexpr float least_thread = 1 / 0.6f;

float thread_of(const ClothAppearance& look) {
    // Coarser than real yarn, so that the weave is seen at the distance a whole cloth is shown from.
    // A twill lives by its diagonals, four threads wide.
    return look.weave == WeavePattern::twill ? std::min(look.period / 9, 0.006f)
                                             : std::min(look.period / 24, 0.0025f);
}

/// Whether light is worked out at vertices.
bool at_vertices(const ClothMesh& mesh, const ClothRenderer::Options& options) {
    if (options.quality == Quality::standard) return options.software && mesh.triangles.size() > fine_mesh;
    return options.quality == Quality::draft;
}

/// `threads`: some may be large enough to be seen.
GlProgram fabric_program(const ClothMesh& mesh, const ClothRenderer::Options& options, bool threads) {
    const ClothAppearance& look = mesh.appearance;
    const std::string defines = fmt::format(
        "#define WEAVE {}\n#define PICTURE {}\n#define LIGHT_AT_VERTICES {}\n#define THREADS {}\n"
        "#define ENCODED {}\n#define SUPERSAMPLE {}\n{}",
        static_cast<int>(look.weave), mesh.texture.pixels.empty() ? 0 : 1, at_vertices(mesh, options) ? 1 : 0,
        threads ? 1 : 0, options.encoded ? 1 : 0, options.supersample, options.light);
    GlProgram program({"frame.glsl", "light.glsl", "sky.glsl", "fabric.glsl", "cloth.vert"},
                      {"frame.glsl", "quads.glsl", "light.glsl", "fabric.glsl", "weave.glsl", "tone.glsl",
                       "color.glsl", "written.glsl", "cloth.frag"},
                      defines);
    ShadowMaps::connect(program);
    program.sampler("picture", 0);
    const Vec3f front = linear(look.front), second = linear(look.front_second), back = linear(look.back);
    const std::array<Vec3f, 2> yarn_front{front, second}, yarn_back{back, mix(back, second, 0.3f)};
    glUniform1f(program.uniform("vertex_gap"), vertex_gap(mesh));
    glUniform1f(program.uniform("per_period"), 1 / look.period);
    glUniform1f(program.uniform("per_thread"), 1 / thread_of(look));
    glUniform3fv(program.uniform("yarn_front"), 2, yarn_front[0].data());
    glUniform3fv(program.uniform("yarn_back"), 2, yarn_back[0].data());
    const std::array<Vec3f, 2> mean{
        mesh.texture.pixels.empty() ? mean_of(look.weave, yarn_front) : mean_of(mesh.texture),
        mean_of(look.weave, yarn_back)};
    glUniform3fv(program.uniform("mean_albedo"), 2, mean[0].data());
    return program;
}

}  // namespace

ClothRenderer::Cloth::Cloth(const ClothMesh& of, const Options& options)
    : mesh(&of),
      near(fabric_program(of, options, true)),
      far(fabric_program(of, options, false)),
      thread(thread_of(of.appearance)) {}

ClothRenderer::ClothRenderer(const DrawScene& scene, const Options& options)
    : supersample_(static_cast<float>(options.supersample)) {
    std::size_t most = 0, particles = 0;
    for (const ClothMesh& mesh : scene.cloths) {
        Cloth& cloth = cloths_.emplace_back(mesh, options);
        const std::size_t count = mesh.particle.size();
        most = std::max(most, count);
        for (const std::uint32_t p : mesh.particle) particles = std::max<std::size_t>(particles, p + 1);

        glBindVertexArray(cloth.vertex_array);
        allocate_buffer(GL_ARRAY_BUFFER, cloth.vertices, count * sizeof(Vertex));
        float_attribute(0, 3, sizeof(Vertex), 0);
        float_attribute(1, 3, sizeof(Vertex), sizeof(Vec3f));
        fill_buffer(GL_ARRAY_BUFFER, cloth.uvs, mesh.uv);
        float_attribute(2, 2, sizeof(Vec2f), 0);
        allocate_buffer(GL_ARRAY_BUFFER, cloth.colors, count * 4);
        glEnableVertexAttribArray(3);
        glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, 4, nullptr);
        fill_buffer(GL_ELEMENT_ARRAY_BUFFER, cloth.indices, in_blocks(mesh));
        // A GPU draws all triangles faster than it is told to draw fewer.
        make_outline(cloth, options.software ? key_casters : count, cloth.casters);
        make_outline(cloth, sky_casters, cloth.coarse);
        glBindVertexArray(0);

        if (!mesh.texture.pixels.empty()) {
            const Vec2f& scale = mesh.picture_scale;
            const auto beyond = [&](const Vec2f& uv) {
                const Vec2f at = uv.cwiseProduct(scale);
                return at.minCoeff() < -1e-4f || at.maxCoeff() > 1 + 1e-4f;
            };
            upload_picture(cloth.texture, mesh.texture, std::ranges::any_of(mesh.uv, beyond));
            for (const GlProgram* program : {&cloth.near, &cloth.far}) {
                program->use();
                glUniform2fv(program->uniform("picture_scale"), 1, scale.data());
            }
        }
    }
    normals_.resize(particles);
    scratch_.resize(most);
    shaded_.resize(particles);
    scratch_colors_.resize(most);
}

void ClothRenderer::update_shape(const DrawFrame& frame) {
    for (Cloth& cloth : cloths_) {
        const std::vector<std::uint32_t>& particle = cloth.mesh->particle;
        smooth_normals(*cloth.mesh, frame.positions, normals_);
        float nearest = std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < particle.size(); ++i) {
            scratch_[i] = {frame.positions[particle[i]], normals_[particle[i]]};
            nearest = std::min(nearest, (scratch_[i].position - frame.camera.position).squaredNorm());
        }
        cloth.distance = std::sqrt(nearest);
        update_buffer(GL_ARRAY_BUFFER, cloth.vertices, std::span(scratch_).first(particle.size()));
    }
}

void ClothRenderer::update_colors(const DrawFrame& frame) {
    // A lamp above the viewer's left shoulder, which lights all sides of folds differently.
    const Vec3f back = (frame.camera.position - frame.camera.target).normalized();
    const Vec3f left = back.cross(frame.camera.up).normalized();
    const Vec3f lamp = (back + 0.6f * left + 0.5f * frame.camera.up).normalized();
    for (const Cloth& cloth : cloths_) {
        const std::vector<std::uint32_t>& particle = cloth.mesh->particle;
        for (const std::uint32_t p : particle) {
            const bool front = normals_[p].dot(frame.camera.position - frame.positions[p]) >= 0;
            const float lit = (front ? 1.f : -1.f) * normals_[p].dot(lamp);
            const float shade = std::min(0.67f + 0.36f * (0.5f + 0.5f * lit), 1.f);  // of encoded colours
            const auto channel = [&](std::uint8_t c) {
                return static_cast<std::uint8_t>(std::lround(shade * static_cast<float>(c)));
            };
            const Rgb c = frame.particle_colors[p];
            shaded_[p] = {channel(c.r), channel(c.g), channel(c.b), 255};
        }
        for (std::size_t i = 0; i < particle.size(); ++i) scratch_colors_[i] = shaded_[particle[i]];
        update_buffer(GL_ARRAY_BUFFER, cloth.colors, std::span(scratch_colors_).first(particle.size()));
    }
}

void ClothRenderer::draw_triangles(const Cloth& cloth) const {
    glBindVertexArray(cloth.vertex_array);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * cloth.mesh->triangles.size()), GL_UNSIGNED_INT,
                   nullptr);
}

void ClothRenderer::draw_shapes() const {
    for (const Cloth& cloth : cloths_) draw_triangles(cloth);
}

void ClothRenderer::draw_coarse() const {
    for (const Cloth& cloth : cloths_) draw_outline(cloth.coarse);
}

void ClothRenderer::draw_casters() const {
    for (const Cloth& cloth : cloths_) draw_outline(cloth.casters);
}

void ClothRenderer::make_outline(const Cloth& cloth, std::size_t particles, Outline& outline) {
    const std::vector<std::array<std::uint32_t, 3>> triangles = coarse_triangles(*cloth.mesh, particles);
    outline.count = static_cast<GLsizei>(3 * triangles.size());
    glBindVertexArray(outline.array);
    glBindBuffer(GL_ARRAY_BUFFER, cloth.vertices);
    float_attribute(0, 3, sizeof(Vertex), 0);
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, outline.indices, triangles);
}

void ClothRenderer::draw_outline(const Outline& outline) {
    glBindVertexArray(outline.array);
    glDrawElements(GL_TRIANGLES, outline.count, GL_UNSIGNED_INT, nullptr);
}

void ClothRenderer::draw_fabric(float pixels) const {
    for (const Cloth& cloth : cloths_) {
        (cloth.thread * pixels > least_thread * supersample_ * cloth.distance ? cloth.near : cloth.far).use();
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, cloth.texture);
        draw_triangles(cloth);
    }
}

}  // namespace unravel::render
