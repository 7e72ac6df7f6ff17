#include "render/egl.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>
#include <string_view>

namespace unravel::render {

namespace {

template <class Function>
void load(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    if (!function) throw std::runtime_error(fmt::format("libEGL.so.1 has no function {}", name));
}

}  // namespace

bool Egl::has(EGLDisplay display, const char* name) const {
    const char* list = QueryString(display, EGL_EXTENSIONS);
    if (!list) {
        GetError();  // an EGL 1.4 client without client extensions answers with an error: it has none
        return false;
    }
    const std::string padded = fmt::format(" {} ", list);
    return padded.find(fmt::format(" {} ", name)) != std::string::npos;
}

std::string Egl::error_text() const {
    const EGLint code = GetError();
    switch (code) {
        case EGL_SUCCESS:
            return "no error was set";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED (the driver did not start)";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS (no permission, or in use by another thread)";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC (out of memory or of another resource)";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE (an option that the driver does not know)";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG (no such frame buffer format)";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT (the context is not valid)";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY (the display is not valid)";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH (the driver cannot give this GL version or format)";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER (an argument that the driver does not accept)";
        case EGL_CONTEXT_LOST:
            return "EGL_CONTEXT_LOST (the device was reset)";
        default:
            return fmt::format("EGL error 0x{:04x}", code);
    }
}

Egl load_egl() {
    Egl egl;
    void* library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(dlerror());
    load(library, "eglGetProcAddress", egl.GetProcAddress);
    load(library, "eglGetError", egl.GetError);
    load(library, "eglQueryString", egl.QueryString);
    load(library, "eglInitialize", egl.Initialize);
    load(library, "eglBindAPI", egl.BindAPI);
    load(library, "eglChooseConfig", egl.ChooseConfig);
    load(library, "eglCreateContext", egl.CreateContext);
    load(library, "eglDestroyContext", egl.DestroyContext);
    load(library, "eglMakeCurrent", egl.MakeCurrent);

    // eglGetPlatformDisplay of EGL 1.5 is missing in EGL 1.4 clients; the EXT twin is in both.
    const auto extension = [&]<class Function>(const char* name, Function& function) {
        function = reinterpret_cast<Function>(egl.GetProcAddress(name));
    };
    extension("eglQueryDevicesEXT", egl.QueryDevicesEXT);
    extension("eglQueryDeviceStringEXT", egl.QueryDeviceStringEXT);
    extension("eglGetPlatformDisplayEXT", egl.GetPlatformDisplayEXT);
    return egl;
}

}  // namespace unravel::render
