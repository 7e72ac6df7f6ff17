#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <type_traits>
#include <vector>

#include "base/file_errors.hpp"

namespace unravel {

/// Bytes put aside on the disk, so that what a long run keeps of each frame takes no memory: a file without a
/// name, which is gone with the program however that ends. Throws OutputError where the disk takes no more,
/// and InputError where it does not give back what it took.
class DiskBuffer {
public:
    /// In the file system of `folder`, which exists.
    explicit DiskBuffer(std::filesystem::path folder);
    ~DiskBuffer();
    DiskBuffer(const DiskBuffer&) = delete;
    DiskBuffer& operator=(const DiskBuffer&) = delete;

    /// Returns the place at which these bytes now lie.
    std::uint64_t append(std::span<const std::byte> bytes);
    void write(std::uint64_t place, std::span<const std::byte> bytes);
    void read(std::uint64_t place, std::span<std::byte> into) const;

private:
    std::filesystem::path folder_;
    int descriptor_;
    std::uint64_t size_ = 0;
};

/// A list of plain values in a buffer of its own.
template <typename T>
class DiskList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit DiskList(const std::filesystem::path& folder) : buffer_(folder) {}

    std::size_t size() const { return size_; }
    void append(std::span<const T> values) {
        buffer_.append(std::as_bytes(values));
        size_ += values.size();
    }
    /// `count` values from the index `first` on; both within the list.
    std::vector<T> read(std::size_t first, std::size_t count) const {
        std::vector<T> values(count);
        buffer_.read(first * sizeof(T), std::as_writable_bytes(std::span(values)));
        return values;
    }
    std::vector<T> read_all() const { return read(0, size_); }
    /// Puts `values` in the place of as many from the first on.
    void replace(std::span<const T> values) { buffer_.write(0, std::as_bytes(values)); }

private:
    DiskBuffer buffer_;
    std::size_t size_ = 0;
};

}  // namespace unravel
