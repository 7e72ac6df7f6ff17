#include "render/egl_routes.hpp"

#include <GL/gl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <fstream>
#include <thread>

namespace unravel::render {

namespace {

// A sentence for each cause, kept together so that the advice stays one voice.
constexpr const char* check_driver =
    "install this device's driver (Mesa: apt-get install libgl1-mesa-dri; NVIDIA: the vendor's libEGL and "
    "its file "
    "in /usr/share/glvnd/egl_vendor.d), or choose --device software";
constexpr const char* check_access =
    "give this user access to /dev/dri/renderD* (usermod -aG render,video USER; in a container pass --device "
    "/dev/dri), or choose --device software";
constexpr const char* reinstall_software =
    "apt-get install --reinstall libgl1-mesa-dri libegl-mesa0: Mesa's software rasteriser does not start";
constexpr const char* reinstall_vendor =
    "apt-get install --reinstall libegl1 libegl-mesa0: /usr/share/glvnd/egl_vendor.d is to hold a file such "
    "as "
    "50_mesa.json, and __EGL_VENDOR_LIBRARY_FILENAMES is not to be set";
constexpr const char* old_gl = "GL 3.3 core is needed: update the driver or choose --device software";

/// Whether GL_RENDERER names a rasteriser that runs on the CPU.
bool is_software(std::string_view renderer) {
    std::string lower(renderer);
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    constexpr std::array names{"llvmpipe", "softpipe", "swrast", "swr", "software rasterizer", "swiftshader"};
    return std::ranges::any_of(names,
                               [&](const char* name) { return lower.find(name) != std::string::npos; });
}

// libepoxy aborts the process where no context is current, and its headers do not agree with EGL's: the few
// GL calls that judge a context go through EGL.
std::string gl_string(const Egl& egl, GLenum name) {
    const auto get = reinterpret_cast<decltype(&::glGetString)>(egl.GetProcAddress("glGetString"));
    const GLubyte* value = get ? get(name) : nullptr;
    return value ? reinterpret_cast<const char*>(value) : "";
}

// Mesa's compiler does not survive a limit on memory that it meets: LLVM ends the program. Address space that
// a software context and pictures of 1280 × 720 were seen to take (Mesa 22.3, LLVM 15), besides stacks and
// arenas of a thread per processor.
constexpr double software_bytes = 1.3e9, software_bytes_per_thread = 8e7;
constexpr unsigned most_software_threads = 16;

// What it has taken once is not taken again.
std::atomic<bool> software_runs{false};

// In words, where a limit leaves too little; else empty.
std::string too_little_memory() {
    rlimit limit{};
    if (software_runs || ::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const double left =
        static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
    const unsigned threads = std::min(most_software_threads, std::thread::hardware_concurrency());
    const double needed = software_bytes + software_bytes_per_thread * threads;
    if (left >= needed) return "";
    return fmt::format("ulimit -v leaves {:.0f} MB, and Mesa's software rasteriser takes about {:.0f}",
                       left / 1e6, needed / 1e6);
}

constexpr const char* raise_limit = "raise the limit: ulimit -v unlimited";

// A route that is not there. Under a limit on memory what lacks is not a vendor's library but room to load
// it.
RendererAttempt missing_route(std::string route, std::string reason, std::string fix) {
    const std::string little = too_little_memory();
    if (!little.empty()) {
        reason = little;
        fix = raise_limit;
    }
    return {.route = std::move(route), .reason = std::move(reason), .fix = std::move(fix)};
}

}  // namespace

CurrentContext::~CurrentContext() {
    // The display itself is left: EGL gives every caller of a route the same one, and ending it here would
    // pull it from under another context. There are as many as there are devices.
    egl_.MakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.DestroyContext(display_, context_);
}

std::string CurrentContext::renderer() const {
    return gl_string(egl_, GL_RENDERER);
}

std::string CurrentContext::version() const {
    return gl_string(egl_, GL_VERSION);
}

int CurrentContext::max_samples() const {
    // GL_MAX_SAMPLES, GL_MAX_COLOR_TEXTURE_SAMPLES, GL_MAX_DEPTH_TEXTURE_SAMPLES: younger than GL/gl.h.
    constexpr GLenum limits[] = {0x8D57, 0x910E, 0x910F};
    const auto get = reinterpret_cast<decltype(&::glGetIntegerv)>(egl_.GetProcAddress("glGetIntegerv"));
    if (!get) return 1;
    GLint least = 64;
    for (const GLenum limit : limits) {
        GLint samples = 1;
        get(limit, &samples);
        least = std::min(least, samples);
    }
    return std::max(least, 1);
}

std::vector<Route> list_routes(const Egl& egl, std::vector<RendererAttempt>& attempts) {
    std::vector<Route> routes;
    if (!egl.GetPlatformDisplayEXT || !egl.has(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) {
        attempts.push_back(missing_route("EGL", "libEGL finds no vendor's library (no EGL_EXT_platform_base)",
                                         reinstall_vendor));
        return routes;
    }
    const bool enumerates = egl.has(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") ||
                            egl.has(EGL_NO_DISPLAY, "EGL_EXT_device_base");
    EGLint count = 0;
    if (!enumerates || !egl.QueryDevicesEXT || !egl.QueryDevicesEXT(0, nullptr, &count) || count == 0) {
        attempts.push_back(
            missing_route("EGL devices",
                          enumerates ? "eglQueryDevicesEXT lists no device: no vendor library was found"
                                     : "this libEGL cannot list devices (EGL_EXT_device_enumeration)",
                          fmt::format("{}; see that /usr/share/glvnd/egl_vendor.d holds a file such as "
                                      "50_mesa.json and that __EGL_VENDOR_LIBRARY_FILENAMES is not set",
                                      install_egl)));
        count = 0;
    }
    std::vector<EGLDeviceEXT> devices(count);
    if (count) egl.QueryDevicesEXT(count, devices.data(), &count);
    for (int i = 0; i < count; ++i) {
        std::string name = fmt::format("EGL device {}", i);
        const char* extensions =
            egl.QueryDeviceStringEXT ? egl.QueryDeviceStringEXT(devices[i], EGL_EXTENSIONS) : nullptr;
        const std::string_view list = extensions ? extensions : "";
        if (list.find("EGL_EXT_device_drm") != list.npos)
            if (const char* file = egl.QueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT))
                name += fmt::format(" ({})", file);
        if (list.find("EGL_MESA_device_software") != list.npos) name += " (software)";
        routes.push_back({name, EGL_PLATFORM_DEVICE_EXT, devices[i], i});
    }
    if (egl.has(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        routes.push_back({"surfaceless platform", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, -1});
    return routes;
}

std::unique_ptr<CurrentContext> reach(const Egl& egl, const Route& route, RendererAttempt& attempt) {
    const auto fail = [&](const char* call, std::string fix) -> std::unique_ptr<CurrentContext> {
        attempt.reason = fmt::format("{} failed: {}", call, egl.error_text());
        attempt.fix = std::move(fix);
        return nullptr;
    };
    EGLDisplay display = egl.GetPlatformDisplayEXT(route.platform, route.native, nullptr);
    if (display == EGL_NO_DISPLAY) return fail("eglGetPlatformDisplayEXT", check_driver);
    EGLint major = 0, minor = 0;
    // What needs no device has no access to lack: its driver is missing or damaged.
    const bool software = route.device < 0 || route.name.find("(software)") != route.name.npos;
    if (software) {
        attempt.reason = too_little_memory();
        attempt.fix = raise_limit;
        if (!attempt.reason.empty()) return nullptr;
        attempt.fix.clear();
    }
    if (!egl.Initialize(display, &major, &minor))
        return fail("eglInitialize", software ? reinstall_software : check_access);
    if (software) software_runs = true;
    if (!egl.BindAPI(EGL_OPENGL_API)) return fail("eglBindAPI(EGL_OPENGL_API)", check_driver);
    if (!egl.has(display, "EGL_KHR_surfaceless_context")) {
        attempt.reason = "the display lacks EGL_KHR_surfaceless_context";
        attempt.fix = check_driver;
        return nullptr;
    }
    // Frames are drawn to our own framebuffer, so any config that can do desktop GL will serve.
    constexpr std::array<EGLint, 5> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                           EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    if (!egl.ChooseConfig(display, wanted.data(), &config, 1, &configs))
        return fail("eglChooseConfig", check_driver);
    if (configs == 0) {
        attempt.reason = "eglChooseConfig finds no format for desktop OpenGL";
        attempt.fix = check_driver;
        return nullptr;
    }
    constexpr std::array<EGLint, 7> version{EGL_CONTEXT_MAJOR_VERSION_KHR,
                                            3,
                                            EGL_CONTEXT_MINOR_VERSION_KHR,
                                            3,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                            EGL_NONE};
    EGLContext context = egl.CreateContext(display, config, EGL_NO_CONTEXT, version.data());
    if (context == EGL_NO_CONTEXT) return fail("eglCreateContext (GL 3.3 core)", old_gl);
    if (!egl.MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        fail("eglMakeCurrent", check_driver);
        egl.DestroyContext(display, context);
        return nullptr;
    }
    auto current = std::make_unique<CurrentContext>(egl, display, context);
    attempt.usable = true;
    attempt.renderer = fmt::format("{}, GL {}", current->renderer(), current->version());
    attempt.software = is_software(current->renderer());
    return current;
}

}  // namespace unravel::render
