#pragma once

// libEGL opened at run time, so that a machine without it gets a sentence and not a loader error.

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>

namespace unravel::render {

/// The EGL entry points used here. The library stays mapped for the life of the process: drivers keep threads
/// and exit handlers in their own code.
struct Egl {
    decltype(&::eglGetProcAddress) GetProcAddress = nullptr;
    decltype(&::eglGetError) GetError = nullptr;
    decltype(&::eglQueryString) QueryString = nullptr;
    decltype(&::eglInitialize) Initialize = nullptr;
    decltype(&::eglBindAPI) BindAPI = nullptr;
    decltype(&::eglChooseConfig) ChooseConfig = nullptr;
    decltype(&::eglCreateContext) CreateContext = nullptr;
    decltype(&::eglDestroyContext) DestroyContext = nullptr;
    decltype(&::eglMakeCurrent) MakeCurrent = nullptr;

    // Extensions; null where the client library lacks them.
    PFNEGLQUERYDEVICESEXTPROC QueryDevicesEXT = nullptr;
    PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceStringEXT = nullptr;
    PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplayEXT = nullptr;

    /// Whether a space-separated extension list holds `name`; `display` EGL_NO_DISPLAY asks the client
    /// library.
    bool has(EGLDisplay display, const char* name) const;
    /// The last error in words, such as "EGL_BAD_ALLOC (out of resources)".
    std::string error_text() const;
};

/// Throws std::runtime_error with the loader's reason where there is no libEGL.so.1.
Egl load_egl();

}  // namespace unravel::render
