#include "base/disk_buffer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

namespace unravel {

namespace {

int open_nameless(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
    if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != ENOENT && errno != EINVAL))
        return descriptor;
    // Network file systems know no files without a name: one that loses it at once.
    std::string name = (folder / ".buffer.XXXXXX").string();
    const int named = ::mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) ::unlink(name.c_str());
    return named;
}

}  // namespace

DiskBuffer::DiskBuffer(std::filesystem::path folder)
    : folder_(std::move(folder)), descriptor_(open_nameless(folder_)) {
    if (descriptor_ < 0) throw OutputError(folder_, errno);
}

DiskBuffer::~DiskBuffer() {
    ::close(descriptor_);
}

std::uint64_t DiskBuffer::append(std::span<const std::byte> bytes) {
    const std::uint64_t place = size_;
    write(place, bytes);
    size_ += bytes.size();
    return place;
}

void DiskBuffer::write(std::uint64_t place, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(place));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) throw OutputError(folder_, errno);
        place += static_cast<std::uint64_t>(written);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void DiskBuffer::read(std::uint64_t place, std::span<std::byte> into) const {
    while (!into.empty()) {
        const ssize_t got = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(place));
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0)
            throw InputError(folder_, "a part of the run that was put aside there can't be read back");
        place += static_cast<std::uint64_t>(got);
        into = into.subspan(static_cast<std::size_t>(got));
    }
}

}  // namespace unravel
