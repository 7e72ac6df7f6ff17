#include "sim/scene_file/similar.hpp"

#include <algorithm>
#include <vector>

namespace unravel::sim {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // Three rows of the usual table: a swap looks back two.
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(above);
        above.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string_view most_similar(std::string_view word, std::span<const std::string_view> candidates,
                              std::size_t farthest) {
    if (word.size() > 64) return {};
    std::string_view best;
    std::size_t best_distance = std::min(farthest, std::max<std::size_t>(1, word.size() / 3)) + 1;
    for (const std::string_view candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string one_of(std::span<const std::string_view> words, char quote) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
        if (quote) out += quote;
        out += words[i];
        if (quote) out += quote;
    }
    return out;
}

}  // namespace unravel::sim
