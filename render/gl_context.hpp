#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace unravel::render {

class CurrentContext;

/// Which renderer the user asks for: `--device auto|gpu|software|N`.
struct DeviceChoice {
    enum class Kind { automatic, gpu, software, index };
    Kind kind = Kind::automatic;  ///< automatic: the first GPU that works, else software
    int index = 0;                ///< of the EGL device, where kind is index
};

/// One route to a renderer and what became of it, for `unravel doctor` and run.json.
struct RendererAttempt {
    std::string route{};     ///< "EGL device 0 (/dev/dri/renderD128)", "surfaceless platform"
    bool usable = false;     ///< reached a current context of GL 3.3 core or newer
    bool software = false;   ///< by GL_RENDERER; meaningful where usable
    std::string renderer{};  ///< GL_RENDERER and GL_VERSION, where reached
    std::string reason{};    ///< why not taken: the call and the EGL error in words; empty for the one taken
    std::string fix{};       ///< what to do about it, empty where nothing is wrong
};

/// No renderer could be had as asked. Exit code 4. The text names every route that was tried.
struct RendererError : std::runtime_error {
    explicit RendererError(const std::string& text, std::vector<RendererAttempt> tried = {})
        : std::runtime_error(text), attempts(std::move(tried)) {}
    std::vector<RendererAttempt> attempts;
};

/// A choice that can't be read: a mistake on the command line.
struct DeviceChoiceError : RendererError {
    using RendererError::RendererError;
};

/// "auto", "gpu", "software" or a device number. Throws DeviceChoiceError on anything else.
DeviceChoice parse_device_choice(std::string_view text);

/// An off-screen GL context, current on the thread that made it until it is destroyed on that thread.
/// Routes: every EGL device in turn, then the surfaceless platform; never the default display.
class GlContext {
public:
    /// Throws RendererError where no route gives what is asked.
    explicit GlContext(DeviceChoice choice = {});
    ~GlContext();
    GlContext(GlContext&&) noexcept;
    GlContext& operator=(GlContext&&) noexcept;

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER
    const std::string& version() const { return version_; }    ///< GL_VERSION
    bool software() const { return software_; }
    int max_samples() const { return max_samples_; }
    const std::vector<RendererAttempt>& attempts() const { return attempts_; }
    /// One line: which renderer was taken and why not another.
    const std::string& summary() const { return summary_; }

private:
    std::unique_ptr<CurrentContext> current_;
    std::string renderer_, version_, summary_;
    bool software_ = false;
    int max_samples_ = 1;
    std::vector<RendererAttempt> attempts_;
};

/// Tries every route to its end and gives the verdicts; never throws for a route that fails.
std::vector<RendererAttempt> probe_renderers();

}  // namespace unravel::render
