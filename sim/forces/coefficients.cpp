#include "sim/forces/coefficients.hpp"

#include <bit>

namespace unravel::sim {

namespace {

constexpr std::size_t most_codes = 256;

bool same(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace

bool Coefficients::find(double value, std::uint8_t& code) {
    if (!code_.empty() && same(value_[code_.back()], value)) {
        code = code_.back();
        return true;
    }
    std::size_t k = 0;
    while (k < value_.size() && !same(value_[k], value)) ++k;
    if (k == most_codes) return false;
    if (k == value_.size()) value_.push_back(value);
    code = static_cast<std::uint8_t>(k);
    return true;
}

void Coefficients::push_back(double value) {
    std::uint8_t code = 0;
    const bool coded = !code_.empty() || value_.empty();
    if (coded && find(value, code)) {
        code_.push_back(code);
    } else {
        own().push_back(value);
    }
}

std::vector<double>& Coefficients::own() {
    if (!code_.empty()) {
        std::vector<double> all(code_.size());
        run(0, all.size(), all.data());
        value_ = std::move(all);
        code_ = {};
    }
    return value_;
}

void Coefficients::code() {
    Coefficients coded;
    coded.code_.reserve(size());
    for (const double value : values()) {
        std::uint8_t code = 0;
        if (!coded.find(value, code)) return;
        coded.code_.push_back(code);
    }
    coded.value_.shrink_to_fit();
    *this = std::move(coded);
}

}  // namespace unravel::sim
