#include "tool/cli/guarded.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include "base/file_errors.hpp"
#include "render/gl_context.hpp"
#include "render/video.hpp"
#include "sim/scene_file/load.hpp"
#include "sim/step/explicit_limit.hpp"
#include "sim/step/step.hpp"
#include "tool/base/exit.hpp"
#include "tool/base/interrupt.hpp"
#include "tool/base/machine.hpp"
#include "tool/cluster/cluster.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

namespace {

OutputError no_standard_output() {
    return OutputError("standard output", "nobody reads it, or its disk is full");
}

}  // namespace

namespace {

// The standard library and TBB each have their own way to say that a thread could not be had.
bool no_more_threads(const std::exception& error) {
    const std::string words = std::generic_category().message(EAGAIN);
    return std::string_view(error.what()).find(words) != std::string_view::npos;
}

}  // namespace

int guarded(const std::function<int()>& command) {
    // A file beyond the limit for files is an error that names the file, not a signal.
    std::signal(SIGXFSZ, SIG_IGN);
    // Not fmt::print: it throws where standard error is closed, and the exit code is to be right even then.
    const auto say = [](const std::string& text) { std::fputs(text.c_str(), stderr); };
    const auto failed = [&](const std::exception& error, int code) {
        say(fmt::format("unravel: {}\n", error.what()));
        return code;
    };
    try {
        const int code = command();
        if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw no_standard_output();
        return code;
    } catch (const SceneError& error) {
        // Its text is a list of located problems, to be read by editors as it is.
        say(fmt::format("{}\n", error.what()));
        return exit_scene;
    } catch (const UnstableStep& error) {
        return failed(error, exit_scene);
    } catch (const UsageError& error) {
        return failed(error, exit_usage);
    } catch (const FolderError& error) {
        return failed(error, exit_usage);
    } catch (const DeviceChoiceError& error) {
        return failed(error, exit_usage);
    } catch (const VideoSettingsError& error) {
        return failed(error, exit_usage);
    } catch (const RendererError& error) {
        return failed(error, exit_no_renderer);
    } catch (const VideoError& error) {
        return failed(error, exit_no_renderer);
    } catch (const MissingPieces& error) {
        return failed(error, exit_simulation);
    } catch (const SimulationError& error) {
        return failed(error, exit_simulation);
    } catch (const Stopped&) {
        return InterruptWatch::exit_code();
    } catch (const std::bad_alloc&) {
        say(fmt::format("unravel: memory ran out: {}; `unravel check` tells what a scene needs\n",
                        memory_room().told()));
        return exit_output;
    } catch (const std::exception& error) {
        if (no_more_threads(error)) {
            say(fmt::format("unravel: threads ran out: {}; --threads 1 needs fewer\n", thread_limit()));
            return exit_output;
        }
        // fmt::print's words for standard output name no file.
        if (std::ferror(stdout) != 0) return failed(no_standard_output(), exit_output);
        return failed(error, exit_output);
    }
}

}  // namespace unravel::tool
