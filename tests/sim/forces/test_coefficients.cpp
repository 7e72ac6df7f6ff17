// Numbers of springs: by code where few differ, each its own beyond, and nobody sees the difference.

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "sim/forces/coefficients.hpp"

using namespace unravel;
using namespace unravel::sim;

namespace {

// `count` numbers, of which `different` differ; not in the order of their first use.
std::vector<double> numbers(std::size_t count, std::size_t different) {
    std::vector<double> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back(1.0 / static_cast<double>(1 + k * 7 % different));
    return out;
}

void require_same(const Coefficients& coefficients, const std::vector<double>& expected) {
    REQUIRE(coefficients.size() == expected.size());
    std::vector<double> buffer(expected.size());
    const double* const run = coefficients.run(1, expected.size() - 1, buffer.data());
    for (std::size_t s = 0; s < expected.size(); ++s) REQUIRE(coefficients[s] == expected[s]);
    for (std::size_t s = 1; s < expected.size(); ++s) REQUIRE(run[s - 1] == expected[s]);
}

}  // namespace

TEST_CASE("coefficients give back what was put in, and take a byte each while few differ") {
    for (const std::size_t different : {1, 3, 256, 257, 999}) {
        INFO(different);
        const std::vector<double> expected = numbers(1000, different);
        Coefficients added, written;
        for (const double value : expected) added.push_back(value);
        written.own() = expected;
        written.code();
        for (const Coefficients* c : {&added, &written}) {
            require_same(*c, expected);
            CHECK(c->bytes() == (different <= 256 ? 1000 + 8 * different : 8000));
        }
        added.own()[17] = 5;
        CHECK(added[17] == 5);
        CHECK(added[16] == expected[16]);
    }
}

TEST_CASE("coefficients keep the sign of zero, and numbers that are none") {
    const Coefficients c{0.0, -0.0, std::numeric_limits<double>::quiet_NaN(), 0.0};
    CHECK(!std::signbit(c[0]));
    CHECK(std::signbit(c[1]));
    CHECK(std::isnan(c[2]));
    CHECK(c.bytes() == 3 * 8 + 4);
}
