#include "tool/bench/sized_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/scene_file/load.hpp"
#include "tool/base/exit.hpp"

namespace unravel::tool {

std::vector<std::size_t> parse_sizes(const std::string& text) {
    constexpr std::size_t least = 25, most = 4'000'000;
    std::vector<std::size_t> sizes;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string word = text.substr(at, end - at);
        std::size_t n = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), n);
        if (error != std::errc() || stop != word.data() + word.size() || n < least || n > most)
            throw UsageError(
                fmt::format("--sizes takes numbers of particles from {} to {} with commas between, not '{}'",
                            least, most, word));
        sizes.push_back(n);
        at = end + 1;
    }
    std::sort(sizes.begin(), sizes.end());
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    return sizes;
}

std::array<int, 2> particles_near(std::size_t n, const std::array<int, 2>& of) {
    const double scale = std::sqrt(static_cast<double>(n) / (static_cast<double>(of[0]) * of[1]));
    const int u = std::max(4, static_cast<int>(std::lround(of[0] * scale)));
    const int v = std::max(4, static_cast<int>(std::lround(static_cast<double>(n) / u)));
    return {u, v};
}

Scene scene_of_size(const std::filesystem::path& file, std::vector<std::string> overrides, std::size_t n) {
    const Scene as_written = load_scene(file, overrides);
    if (as_written.cloths.size() != 1 || !as_written.cloths.front().mesh.file.empty())
        throw UsageError(fmt::format("bench refines a scene's cloth, so {} needs one cloth that is a grid",
                                     file.string()));
    const auto [u, v] = particles_near(n, as_written.cloths.front().particles);
    overrides.push_back(fmt::format("cloth.particles=[{},{}]", u, v));
    return load_scene(file, overrides);
}

}  // namespace unravel::tool
