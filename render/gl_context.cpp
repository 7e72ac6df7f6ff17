#include "render/gl_context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "render/egl_routes.hpp"

namespace unravel::render {

namespace {

RendererAttempt no_library(const std::exception& error) {
    return {.route = "libEGL.so.1", .reason = error.what(), .fix = install_egl};
}

bool fits(const DeviceChoice& choice, const Route& route, const RendererAttempt& attempt) {
    switch (choice.kind) {
        case DeviceChoice::Kind::automatic:
            return true;
        case DeviceChoice::Kind::gpu:
            return !attempt.software;
        case DeviceChoice::Kind::software:
            return attempt.software;
        case DeviceChoice::Kind::index:
            return route.device == choice.index;
    }
    return false;
}

std::string describe(const DeviceChoice& choice) {
    switch (choice.kind) {
        case DeviceChoice::Kind::automatic:
            return "auto";
        case DeviceChoice::Kind::gpu:
            return "gpu";
        case DeviceChoice::Kind::software:
            return "software";
        case DeviceChoice::Kind::index:
            return fmt::format("{}", choice.index);
    }
    return {};
}

std::string list_failures(const std::vector<RendererAttempt>& attempts) {
    std::string text;
    const auto same = [&](const RendererAttempt& attempt) {
        return attempt.reason == attempts.front().reason && attempt.fix == attempts.front().fix;
    };
    // One cause, told once.
    if (!attempts.empty() && std::ranges::all_of(attempts, same))
        return fmt::format(" {}; {}", attempts.front().reason, attempts.front().fix);
    for (const RendererAttempt& attempt : attempts) {
        text += fmt::format("\n  {}: {}", attempt.route, attempt.reason);
        if (!attempt.fix.empty()) text += fmt::format("\n    try: {}", attempt.fix);
    }
    return text;
}

}  // namespace

DeviceChoice parse_device_choice(std::string_view text) {
    using Kind = DeviceChoice::Kind;
    if (text == "auto") return {Kind::automatic};
    if (text == "gpu") return {Kind::gpu};
    if (text == "software") return {Kind::software};
    int index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size() || index < 0)
        throw DeviceChoiceError(fmt::format(
            "--device {}: give auto, gpu, software or the number of an EGL device (unravel doctor lists "
            "them)",
            text));
    return {Kind::index, index};
}

GlContext::GlContext(DeviceChoice choice) {
    Egl egl;
    try {
        egl = load_egl();
    } catch (const std::runtime_error& error) {
        attempts_.push_back(no_library(error));
        throw RendererError(fmt::format("no renderer:{}", list_failures(attempts_)), attempts_);
    }

    // A GPU ends the search; the first software renderer is opened again where no GPU answers.
    const bool automatic = choice.kind == DeviceChoice::Kind::automatic;
    const Route* fallback = nullptr;
    std::size_t fallback_attempt = 0, taken = 0;
    const std::vector<Route> routes = list_routes(egl, attempts_);
    for (const Route& route : routes) {
        if (choice.kind == DeviceChoice::Kind::index && route.device != choice.index) continue;
        RendererAttempt& attempt = attempts_.emplace_back(RendererAttempt{.route = route.name});
        std::unique_ptr<CurrentContext> reached = reach(egl, route, attempt);
        if (!reached) continue;
        if (!fits(choice, route, attempt)) {
            attempt.reason = fmt::format("it is {}, and --device {} was asked",
                                         attempt.software ? "software" : "a GPU", describe(choice));
        } else if (automatic && attempt.software) {
            attempt.reason = "software, of which one is enough";
            if (!fallback) {
                fallback = &route;
                fallback_attempt = attempts_.size() - 1;
            }
        } else {
            taken = attempts_.size() - 1;
            current_ = std::move(reached);
            break;
        }
    }
    if (!current_ && fallback) {
        taken = fallback_attempt;
        attempts_[taken].reason.clear();
        current_ = reach(egl, *fallback, attempts_[taken]);
    }
    if (!current_)
        throw RendererError(
            fmt::format("no renderer for --device {}:{}", describe(choice),
                        attempts_.empty() ? " there is no such EGL device; unravel doctor lists them"
                                          : list_failures(attempts_)),
            attempts_);

    renderer_ = current_->renderer();
    version_ = current_->version();
    software_ = attempts_[taken].software;
    max_samples_ = current_->max_samples();
    summary_ =
        fmt::format("{} ({}) through {}", renderer_, software_ ? "software" : "GPU", attempts_[taken].route);
    if (!automatic) summary_ += fmt::format(", as --device {} asks", describe(choice));
    if (automatic && software_) {
        std::string others;
        for (const RendererAttempt& attempt : attempts_)
            if (!attempt.usable) others += fmt::format("; {}: {}", attempt.route, attempt.reason);
        summary_ += others.empty() ? "; EGL lists no GPU" : others;
    }
}

GlContext::~GlContext() = default;
GlContext::GlContext(GlContext&&) noexcept = default;

GlContext& GlContext::operator=(GlContext&&) noexcept = default;

std::vector<RendererAttempt> probe_renderers() {
    std::vector<RendererAttempt> attempts;
    try {
        const Egl egl = load_egl();
        for (const Route& route : list_routes(egl, attempts)) {
            RendererAttempt attempt{.route = route.name};
            reach(egl, route, attempt);  // let go at once
            attempts.push_back(std::move(attempt));
        }
    } catch (const std::runtime_error& error) {
        attempts.push_back(no_library(error));
    }
    return attempts;
}

}  // namespace unravel::render
