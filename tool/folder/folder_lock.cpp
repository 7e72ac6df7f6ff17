#include "tool/folder/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "base/file_errors.hpp"
#include "tool/folder/run_folder.hpp"

namespace unravel::tool {

FolderLock::FolderLock(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw OutputError(folder, error.value());
    descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor_ < 0) throw OutputError(folder, errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw FolderError(fmt::format(
        "another run of unravel is writing to '{}': wait for it, or put this one elsewhere with -o DIR",
        folder.string()));
}

FolderLock::~FolderLock() {
    ::close(descriptor_);
}

}  // namespace unravel::tool
