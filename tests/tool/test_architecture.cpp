#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "source_dir.hpp"

namespace fs = std::filesystem;

namespace {

std::string text_of_page(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// What stands between backticks and looks like a file of the sources: "sim/linear/solve.hpp".
std::set<std::string> named_files(const std::string& text) {
    std::set<std::string> files;
    for (std::size_t at = text.find('`'); at != text.npos;) {
        const std::size_t end = text.find('`', at + 1);
        if (end == text.npos) break;
        const std::string word = text.substr(at + 1, end - at - 1);
        const bool file = word.find('/') != word.npos && word.find_first_of(" <>*") == word.npos &&
                          (word.ends_with(".cpp") || word.ends_with(".hpp") || word.ends_with(".txt"));
        if (file) files.insert(word);
        at = text.find('`', end + 1);
    }
    return files;
}

}  // namespace

TEST_CASE("every file that docs/architecture.md names is there, and every recipe names some", "[docs]") {
    const fs::path sources = UNRAVEL_SOURCE_DIR;
    const std::string page = text_of_page(sources / "docs" / "architecture.md");
    for (const std::string& file : named_files(page)) {
        CAPTURE(file);
        CHECK(fs::exists(sources / file));
    }
    const std::string recipes = page.substr(page.find("## Recipes"));
    for (const char* what : {"force", "integrator", "preconditioner", "solid", "export", "colouring"}) {
        CAPTURE(what);
        std::size_t begin = recipes.find(std::string("**A ") + what);
        if (begin == recipes.npos) begin = recipes.find(std::string("**An ") + what);
        REQUIRE(begin != recipes.npos);
        const std::string recipe = recipes.substr(begin, recipes.find("\n\n", begin) - begin);
        CHECK(named_files(recipe).size() >= 3);
        CHECK(recipe.find("`tests/") != recipe.npos);
    }
}
