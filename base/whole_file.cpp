#include "base/whole_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <system_error>
#include <utility>

namespace unravel {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view partial_ending = ".part";

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int get() const { return number_; }

private:
    int number_;
};

// A number for this machine, so that equal process numbers on two of them are told apart.
std::uint32_t machine_number() {
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    std::uint32_t number = 2166136261;  // FNV-1a
    for (const char* c = name.data(); *c != 0; ++c)
        number = (number ^ static_cast<unsigned char>(*c)) * 16777619;
    return number;
}

// Hidden, so that nothing that looks for frames by their names meets it; with numbers of process and machine,
// so that two runs that work in one folder, or are done twice, can't mix their bytes.
fs::path partial_path(const fs::path& target) {
    static const std::uint32_t machine = machine_number();
    return target.parent_path() /
           fmt::format(".{}.{}{:010}{}", target.filename().string(), ::getpid(), machine, partial_ending);
}

// True for .NAME.DIGITS.part
bool is_partial_name(std::string_view name) {
    if (!name.starts_with('.') || !name.ends_with(partial_ending)) return false;
    name.remove_suffix(partial_ending.size());
    const auto dot = name.rfind('.');
    if (dot < 2 || dot + 1 == name.size()) return false;
    return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(dot) + 1, name.end(),
                       [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Some file systems know no fsync (EINVAL): there a rename is all that can be had.
bool flush_to_disk(int descriptor) {
    return ::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP;
}

}  // namespace

WholeFile::WholeFile(fs::path target) : target_(std::move(target)), temporary_(partial_path(target_)) {
    struct stat existing {};
    if (!target_.has_filename()) throw OutputError(target_, EISDIR);
    if (::stat(target_.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode)) {
        if (S_ISDIR(existing.st_mode)) throw OutputError(target_, EISDIR);
        throw OutputError(target_, "it is a device or a pipe, not a file");
    }
    const int descriptor =
        ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (descriptor < 0) throw OutputError(target_, errno);
    file_.reset(::fdopen(descriptor, "wb"));
    if (!file_) {
        const int reason = errno;
        ::close(descriptor);
        ::unlink(temporary_.c_str());
        throw OutputError(target_, reason);
    }
}

WholeFile::~WholeFile() {
    if (temporary_.empty()) return;
    file_.reset();
    ::unlink(temporary_.c_str());
}

void WholeFile::write(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
        throw OutputError(target_, errno);
}

void WholeFile::commit() {
    if (std::fflush(file_.get()) != 0) throw OutputError(target_, errno);
    if (!flush_to_disk(::fileno(file_.get()))) throw OutputError(target_, errno);
    // Network file systems report a full disk as late as here.
    if (std::fclose(file_.release()) != 0) throw OutputError(target_, errno);
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) throw OutputError(target_, errno);
    temporary_.clear();

    const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.get() < 0) {
        // A folder may be writable without being readable; its name entry is then flushed in the system's own
        // time.
        if (errno == EACCES) return;
        throw OutputError(target_, errno);
    }
    if (!flush_to_disk(opened.get())) throw OutputError(target_, errno);
}

void write_whole_file(const fs::path& target, std::span<const std::byte> bytes) {
    WholeFile file(target);
    file.write(bytes);
    file.commit();
}

void write_whole_file(const fs::path& target, std::span<const std::uint8_t> bytes) {
    write_whole_file(target, std::as_bytes(bytes));
}

void write_whole_file(const fs::path& target, std::string_view text) {
    write_whole_file(target, std::as_bytes(std::span(text)));
}

int remove_partial_files(const fs::path& folder) {
    std::error_code error;
    fs::directory_iterator entries(folder, error);
    if (error == std::errc::no_such_file_or_directory) return 0;
    if (error) throw OutputError(folder, error.value());
    int removed = 0;
    for (const auto& entry : entries) {
        if (!is_partial_name(entry.path().filename().string()) || !entry.is_regular_file(error)) continue;
        if (!fs::remove(entry.path(), error)) throw OutputError(entry.path(), error.value());
        ++removed;
    }
    return removed;
}

std::vector<std::uint8_t> read_whole_file(const fs::path& file, std::size_t limit) {
    // Not blocking: a pipe under the file's name must not hang the program.
    const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    struct stat facts {};
    if (opened.get() < 0 || ::fstat(opened.get(), &facts) != 0)
        throw InputError(file, std::generic_category().message(errno));
    if (!S_ISREG(facts.st_mode)) throw InputError(file, "it is not a regular file");
    if (static_cast<std::size_t>(facts.st_size) > limit)
        throw InputError(file,
                         fmt::format("it holds {} bytes, more than the {} allowed", facts.st_size, limit));
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(facts.st_size));
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(opened.get(), bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw InputError(file, std::generic_category().message(errno));
        if (got == 0) throw InputError(file, "it became shorter while it was read");
        done += static_cast<std::size_t>(got);
    }
    return bytes;
}

std::string read_whole_text(const std::filesystem::path& file, std::size_t limit) {
    const std::vector<std::uint8_t> bytes = read_whole_file(file, limit);
    return {bytes.begin(), bytes.end()};
}

}  // namespace unravel
