#pragma once

#include <span>
#include <string>
#include <string_view>

namespace unravel::sim {

/// Insertions, deletions, substitutions and swaps of neighbours that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate nearest to the word, if it is near enough to be meant (a third of its letters may differ, at
/// most `farthest`); empty if none is. The first of equals wins.
std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates,
                              std::size_t farthest = 3);

/// "a", "a or b", "a, b or c", each in the given quotes (none if zero).
std::string one_of(std::span<const std::string_view> words, char quote);

}  // namespace unravel::sim
