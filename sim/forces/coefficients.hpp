#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <vector>

namespace unravel::sim {

/// One number for each spring of a list. The springs of a grid are alike but for borders and regions: while
/// no more than 256 different numbers are in the list, a byte for each spring says which it has; beyond, as
/// on meshes, each has its own.
class Coefficients {
public:
    Coefficients() = default;
    Coefficients(std::initializer_list<double> values) {
        for (const double value : values) push_back(value);
    }

    std::size_t size() const { return code_.empty() ? value_.size() : code_.size(); }
    double operator[](std::size_t s) const { return code_.empty() ? value_[s] : value_[code_[s]]; }
    double back() const { return (*this)[size() - 1]; }
    /// All of them, in order.
    auto values() const {
        return std::views::iota(std::size_t{0}, size()) |
               std::views::transform([this](std::size_t s) { return (*this)[s]; });
    }
    /// `count` of them from `first` on, one after another: as they lie, or copied to `buffer` (count).
    const double* run(std::size_t first, std::size_t count, double* buffer) const {
        if (code_.empty()) return value_.data() + first;
        for (std::size_t k = 0; k < count; ++k) buffer[k] = value_[code_[first + k]];
        return buffer;
    }

    void push_back(double value);
    /// Each spring's own number, to be written.
    std::vector<double>& own();
    /// Says by codes what has been written, where few enough differ.
    void code();
    std::size_t bytes() const { return value_.size() * sizeof(double) + code_.size(); }

private:
    // The code of a number, bit by bit; false where it has none and there is none left.
    bool find(double value, std::uint8_t& code);

    std::vector<double> value_;       // by spring, or by code
    std::vector<std::uint8_t> code_;  // (springs); empty: by spring
};

}  // namespace unravel::sim
