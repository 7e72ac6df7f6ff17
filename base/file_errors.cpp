#include "base/file_errors.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <cerrno>
#include <utility>

namespace unravel {
namespace {

// "ulimit -f allows 10 kB here"
std::string size_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
    return fmt::format("; ulimit -f allows files of {} kB here: raise it", limit.rlim_cur / 1024);
}

std::string advice(int error_number) {
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
            return "; free some space there, or write to another folder";
        case EACCES:
        case EPERM:
        case EROFS:
            return "; write to a folder that you may write to";
        case ENOENT:
            return "; its folder does not exist";
        case ENOTDIR:
            return "; a part of the path is a file, not a folder";
        case EFBIG:
            return size_limit();
        default:
            return "";
    }
}

}  // namespace

OutputError::OutputError(std::filesystem::path file, int error_number)
    : std::system_error(error_number, std::generic_category()),
      file_(std::move(file)),
      text_(fmt::format("can't write {}: {}{}", file_.string(), code().message(), advice(error_number))) {}

OutputError::OutputError(std::filesystem::path file, const std::string& reason)
    : std::system_error(EIO, std::generic_category()),
      file_(std::move(file)),
      text_(fmt::format("can't write {}: {}", file_.string(), reason)) {}

InputError::InputError(std::filesystem::path file, const std::string& reason)
    : std::runtime_error(fmt::format("can't read {}: {}", file.string(), reason)), file_(std::move(file)) {}

}  // namespace unravel
