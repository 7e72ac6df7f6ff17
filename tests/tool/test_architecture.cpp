#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
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
        int changed = 0, tests = 0;
        for (const std::string& file : named_files(recipe)) ++(file.starts_with("tests/") ? tests : changed);
        CHECK(changed >= 2);
        CHECK(changed <= 3);
        CHECK(tests == 1);
    }
}

// A value that has a file of its own is named by the list that its recipe names, and by nothing else that
// would have to be changed with it. Studies and the bench say which values they compare.
TEST_CASE("a choice is named where its recipe says and nowhere else", "[docs]") {
    const std::map<std::string, std::set<std::string>> named_by{
        {"Shape::box", {}},
        {"Shape::capsule", {}},
        {"Show::contact", {"tool/picture/legend.cpp", "tool/picture/wire_colors.cpp"}},
        {"Preconditioner::ssor", {"sim/linear/methods.cpp"}},
        {"Integrator::bdf2", {"sim/integrators/scheme.cpp"}},
        {"gravity_term", {"sim/terms/gravity.cpp", "sim/terms/gravity.hpp", "sim/terms/terms.hpp"}},
    };
    const fs::path sources = UNRAVEL_SOURCE_DIR;
    std::map<std::string, std::set<std::string>> found;
    for (const char* folder : {"sim", "render", "tool"}) {
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(sources / folder)) {
            const std::string file = fs::relative(entry.path(), sources).generic_string();
            const bool source = file.ends_with(".cpp") || file.ends_with(".hpp");
            if (!source || file.starts_with("tool/study/") || file.starts_with("tool/bench/")) continue;
            const std::string text = text_of_page(entry.path());
            for (const auto& [value, files] : named_by)
                if (text.find(value) != text.npos) found[value].insert(file);
        }
    }
    for (const auto& [value, files] : named_by) {
        CAPTURE(value);
        CHECK(found[value] == files);
    }
}
