#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file_errors.hpp"

namespace unravel {

/// A file that appears whole or not at all, however the program ends. Bytes go to a hidden file beside the
/// target; commit() flushes them to the disk, renames the file over the target, and flushes the folder.
/// Without commit() the destructor removes the hidden file, and the target stays what it was.
///
/// All functions throw OutputError. Different targets may be written from different threads at the same time.
class WholeFile {
public:
    /// Creates the hidden file; the target's folder must exist. A target that exists and is no regular file
    /// (a device, a folder) is refused: renaming would replace it.
    explicit WholeFile(std::filesystem::path target);
    ~WholeFile();
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;

    void write(std::span<const std::byte> bytes);
    void write(std::span<const std::uint8_t> bytes) { write(std::as_bytes(bytes)); }
    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

    /// Where the bytes lie before commit(), for libraries that want a name to write to. They write before
    /// commit() and this object writes nothing itself.
    const std::filesystem::path& temporary() const { return temporary_; }
    const std::filesystem::path& target() const { return target_; }

    /// After this the file is on the disk under its own name. Called once, last.
    void commit();

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    std::filesystem::path target_, temporary_;
    std::unique_ptr<std::FILE, Close> file_;
};

/// The whole content at once.
void write_whole_file(const std::filesystem::path& target, std::span<const std::byte> bytes);
void write_whole_file(const std::filesystem::path& target, std::span<const std::uint8_t> bytes);
void write_whole_file(const std::filesystem::path& target, std::string_view text);

/// Removes what killed runs have left of unfinished whole files directly in `folder` (not below it), and
/// returns how many there were. A folder that does not exist has none. No other program may be writing there.
int remove_partial_files(const std::filesystem::path& folder);

/// The content of a regular file. Throws InputError if it can't be read or holds more than `limit` bytes; the
/// limit is checked before memory is taken.
std::vector<std::uint8_t> read_whole_file(const std::filesystem::path& file, std::size_t limit);
std::string read_whole_text(const std::filesystem::path& file, std::size_t limit);

}  // namespace unravel
