#include "sim/scene_file/similar.hpp"

#include <catch2/catch.hpp>

using namespace unravel;
using namespace unravel::sim;

TEST_CASE("edit distance counts insertions, deletions, substitutions and swaps", "[scene]") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("abc", "") == 3);
    CHECK(edit_distance("radius", "radus") == 1);
    CHECK(edit_distance("radius", "radjus") == 1);
    CHECK(edit_distance("friction", "firction") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
}

TEST_CASE("only a near word is suggested", "[scene]") {
    constexpr std::string_view words[] = {"size", "density", "center"};
    CHECK(most_similar("desnity", words) == "density");
    CHECK(most_similar("centre", words) == "center");
    CHECK(most_similar("qwerty", words).empty());
    CHECK(most_similar(std::string(100'000, 'd'), words).empty());
}
