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
class Spool {
public:
    /// In the file system of `folder`, which exists.
    explicit Spool(std::filesystem::path folder);
    ~Spool();
    Spool(const Spool&) = delete;
    Spool& operator=(const Spool&) = delete;

    /// Returns the place at which these bytes now lie.
    std::uint64_t append(std::span<const std::byte> bytes);
    void write(std::uint64_t place, std::span<const std::byte> bytes);
    void read(std::uint64_t place, std::span<std::byte> into) const;

private:
    std::filesystem::path folder_;
    int descriptor_;
    std::uint64_t size_ = 0;
};

/// A list of plain values in a spool of its own.
template <typename T>
class SpooledList {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    explicit SpooledList(const std::filesystem::path& folder) : spool_(folder) {}

    std::size_t size() const { return size_; }
    void append(std::span<const T> values) {
        spool_.append(std::as_bytes(values));
        size_ += values.size();
    }
    /// `count` values from the index `first` on; both within the list.
    std::vector<T> read(std::size_t first, std::size_t count) const {
        std::vector<T> values(count);
        spool_.read(first * sizeof(T), std::as_writable_bytes(std::span(values)));
        return values;
    }
    std::vector<T> read_all() const { return read(0, size_); }
    /// Puts `values` in the place of as many from the first on.
    void replace(std::span<const T> values) { spool_.write(0, std::as_bytes(values)); }

private:
    Spool spool_;
    std::size_t size_ = 0;
};

}  // namespace unravel
