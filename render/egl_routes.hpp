#pragma once

#include <memory>
#include <vector>

#include "render/egl.hpp"
#include "render/gl_context.hpp"

namespace unravel::render {

/// A way to a display that was not tried yet.
struct Route {
    std::string name;
    EGLenum platform = 0;
    void* native = nullptr;
    int device = -1;  ///< EGL device number; −1: the surfaceless platform
};

/// A GL context that is current on this thread until it is destroyed.
class CurrentContext {
public:
    CurrentContext(const Egl& egl, EGLDisplay display, EGLContext context)
        : egl_(egl), display_(display), context_(context) {}
    ~CurrentContext();
    CurrentContext(const CurrentContext&) = delete;
    CurrentContext& operator=(const CurrentContext&) = delete;

    std::string renderer() const;  ///< GL_RENDERER
    std::string version() const;   ///< GL_VERSION
    int max_samples() const;       ///< of a picture that shaders read

private:
    Egl egl_;
    EGLDisplay display_;
    EGLContext context_;
};

/// What to install where there is no libEGL.
constexpr const char* install_egl = "apt-get install libegl1 libgl1-mesa-dri";

/// Every EGL device, then the surfaceless platform. What keeps routes from being listed is added to
/// `attempts`.
std::vector<Route> list_routes(const Egl& egl, std::vector<RendererAttempt>& attempts);

/// Follows one route to a current context of GL 3.3 core or newer. Fills `attempt`; where it fails, with the
/// call that stopped it, and gives nothing.
std::unique_ptr<CurrentContext> reach(const Egl& egl, const Route& route, RendererAttempt& attempt);

}  // namespace unravel::render
