#pragma once

// Small owners of GL names. All need a current context, and die before it.

#include <epoxy/gl.h>

#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace unravel::render {

/// Owns one GL name; moves, never copies.
template <void (*create)(GLuint*), void (*destroy)(GLuint)>
class GlName {
public:
    GlName() { create(&name_); }
    ~GlName() {
        if (name_) destroy(name_);
    }
    GlName(GlName&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    operator GLuint() const { return name_; }

private:
    GLuint name_ = 0;
};

namespace gl_names {
inline void create_buffer(GLuint* name) {
    glGenBuffers(1, name);
}
inline void destroy_buffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
inline void create_vertex_array(GLuint* name) {
    glGenVertexArrays(1, name);
}
inline void destroy_vertex_array(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
inline void create_texture(GLuint* name) {
    glGenTextures(1, name);
}
inline void destroy_texture(GLuint name) {
    glDeleteTextures(1, &name);
}
inline void create_renderbuffer(GLuint* name) {
    glGenRenderbuffers(1, name);
}
inline void destroy_renderbuffer(GLuint name) {
    glDeleteRenderbuffers(1, &name);
}
inline void create_sampler(GLuint* name) {
    glGenSamplers(1, name);
}
inline void destroy_sampler(GLuint name) {
    glDeleteSamplers(1, &name);
}
inline void create_framebuffer(GLuint* name) {
    glGenFramebuffers(1, name);
}
inline void destroy_framebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
}  // namespace gl_names

using GlBuffer = GlName<gl_names::create_buffer, gl_names::destroy_buffer>;
using GlVertexArray = GlName<gl_names::create_vertex_array, gl_names::destroy_vertex_array>;
using GlTexture = GlName<gl_names::create_texture, gl_names::destroy_texture>;
using GlSampler = GlName<gl_names::create_sampler, gl_names::destroy_sampler>;
using GlRenderbuffer = GlName<gl_names::create_renderbuffer, gl_names::destroy_renderbuffer>;
using GlFramebuffer = GlName<gl_names::create_framebuffer, gl_names::destroy_framebuffer>;

/// Storage for `bytes`, to be filled by update_buffer every frame.
void allocate_buffer(GLenum target, GLuint buffer, std::size_t bytes, GLenum usage = GL_DYNAMIC_DRAW);

/// Storage filled once from contiguous values.
template <class Values>
void fill_buffer(GLenum target, GLuint buffer, const Values& values) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(std::span(values).size_bytes()), values.data(),
                 GL_STATIC_DRAW);
}

/// Vertices of the two triangles of each of `count` quads, whose corners are vertices 4 k … 4 k + 3.
std::vector<std::uint32_t> quad_indices(std::size_t count);

/// Storage of a texture that is read texel by texel: one level, no filter. Leaves it bound.
void allocate_texels(GLuint texture, GLenum format, int width, int height, GLenum channels, GLenum type);

/// Overwrites the beginning of a buffer that allocate_buffer made.
template <class Values>
void update_buffer(GLenum target, GLuint buffer, const Values& values) {
    glBindBuffer(target, buffer);
    glBufferSubData(target, 0, static_cast<GLsizeiptr>(std::span(values).size_bytes()), values.data());
}

/// One float attribute of the bound vertex array, read from the buffer bound to GL_ARRAY_BUFFER.
void float_attribute(GLuint location, int components, int stride_bytes, std::size_t offset_bytes);

/// A linked pair of shaders. Its block "Frame", where it has one, reads binding point 0.
class GlProgram {
public:
    using Files = std::initializer_list<std::string_view>;
    /// Each stage is the concatenation of embedded files of shaders/, in order, after "#version 330 core".
    /// `defines`: preprocessor lines that go before both. Throws std::logic_error with the compiler's words:
    /// a shader that does not compile is our mistake.
    GlProgram(Files vertex, Files fragment, std::string_view defines = {});
    ~GlProgram();
    GlProgram(GlProgram&& other) noexcept : program_(std::exchange(other.program_, 0)) {}
    GlProgram& operator=(GlProgram&&) = delete;

    void use() const { glUseProgram(program_); }
    /// Location of a uniform; −1, which GL ignores, where the compiler removed it.
    GLint uniform(const char* name) const { return glGetUniformLocation(program_, name); }
    /// Points a sampler at a texture unit, once and for all.
    void sampler(const char* name, int unit) const;

private:
    GLuint program_ = 0;
};

}  // namespace unravel::render
