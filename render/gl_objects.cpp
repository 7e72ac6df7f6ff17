#include "render/gl_objects.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "render/shader_sources.hpp"

namespace unravel::render {

namespace {

GLuint compile(GLenum stage, GlProgram::Files files, std::string_view defines) {
    std::string source = fmt::format("#version 330 core\n{}", defines), names;
    for (const std::string_view file : files) {
        const std::string_view text = shader_source(file);
        if (text.empty()) throw std::logic_error(fmt::format("there is no shader {}", file));
        names += fmt::format("{} ", file);
        source += "#line 1\n";
        source += text;
    }
    const GLuint shader = glCreateShader(stage);
    const char* begin = source.c_str();
    glShaderSource(shader, 1, &begin, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        std::string log(4096, ' ');
        GLsizei length = 0;
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
        glDeleteShader(shader);
        throw std::logic_error(fmt::format("shader {}: {}", names, log.substr(0, length)));
    }
    return shader;
}

}  // namespace

void allocate_buffer(GLenum target, GLuint buffer, std::size_t bytes, GLenum usage) {
    glBindBuffer(target, buffer);
    glBufferData(target, static_cast<GLsizeiptr>(bytes), nullptr, usage);
}

std::vector<std::uint32_t> quad_indices(std::size_t count) {
    std::vector<std::uint32_t> indices;
    indices.reserve(6 * count);
    for (std::size_t k = 0; k < count; ++k) {
        const auto v = static_cast<std::uint32_t>(4 * k);
        indices.insert(indices.end(), {v, v + 1, v + 2, v + 2, v + 1, v + 3});
    }
    return indices;
}

void allocate_texels(GLuint texture, GLenum format, int width, int height, GLenum channels, GLenum type) {
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, channels, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void float_attribute(GLuint location, int components, int stride_bytes, std::size_t offset_bytes) {
    glEnableVertexAttribArray(location);
    // GL takes an offset as a pointer.
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, stride_bytes,
                          reinterpret_cast<const void*>(offset_bytes));  // NOLINT(performance-no-int-to-ptr)
}

GlProgram::GlProgram(Files vertex, Files fragment, std::string_view defines) {
    const GLuint vertex_shader = compile(GL_VERTEX_SHADER, vertex, defines);
    const GLuint fragment_shader = compile(GL_FRAGMENT_SHADER, fragment, defines);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex_shader);
    glAttachShader(program_, fragment_shader);
    glLinkProgram(program_);
    glDeleteShader(vertex_shader);
    glDeleteShader(fragment_shader);
    GLint linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &linked);
    if (!linked) {
        std::string log(4096, ' ');
        GLsizei length = 0;
        glGetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), &length, log.data());
        glDeleteProgram(program_);
        throw std::logic_error(fmt::format("linking {}: {}", *vertex.begin(), log.substr(0, length)));
    }
    const GLuint block = glGetUniformBlockIndex(program_, "Frame");
    if (block != GL_INVALID_INDEX) glUniformBlockBinding(program_, block, 0);
}

GlProgram::~GlProgram() {
    glDeleteProgram(program_);
}

void GlProgram::sampler(const char* name, int unit) const {
    use();
    glUniform1i(uniform(name), unit);
}

}  // namespace unravel::render
