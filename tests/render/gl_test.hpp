#pragma once

#include <catch2/catch.hpp>
#include <optional>

#include "render/gl_context.hpp"

namespace unravel::testing {

using namespace render;

/// A context for a test whose name says GL, or nothing, said aloud, where the machine has no renderer at all.
inline std::optional<GlContext> open_renderer() {
    try {
        return GlContext();
    } catch (const RendererError& error) {
        WARN("skipped: " << error.what());
        return std::nullopt;
    }
}

}  // namespace unravel::testing
