#include "render/gl_objects.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "render/shader_sources.hpp"

namespace unravel {

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

void float_attribute(GLuint location, int components, int stride_bytes, std::size_t offset_bytes) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, components, GL_FLOAT, GL_FALSE, stride_bytes,
                          reinterpret_cast<const void*>(offset_bytes));
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

}  // namespace unravel
