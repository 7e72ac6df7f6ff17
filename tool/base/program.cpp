#include "tool/base/program.hpp"

#include "source_dir.hpp"

namespace unravel::tool {

namespace fs = std::filesystem;

fs::path program_file() {
    std::error_code error;
    fs::path path = fs::read_symlink("/proc/self/exe", error);
    return error ? fs::path("unravel") : path;
}

fs::path shipped_scenes() {
    const fs::path installed = program_file().parent_path().parent_path() / "share" / "unravel" / "scenes";
    std::error_code error;
    return fs::is_directory(installed, error) ? installed : fs::path(UNRAVEL_SCENES);
}

}  // namespace unravel::tool
