#include "tool/cli/description.hpp"

#include <catch2/catch.hpp>

#include "tool/cli/commands.hpp"

using namespace unravel::tool;

namespace {

// A command line with a place, words, a number, a flag and two commands.
struct Small {
    std::string place, colour;
    int count = 3;
    bool loud = false;
    CLI::App app{"A small tool's text - with 'quotes'.", "small"};
    Small() {
        CLI::App* paint = app.add_subcommand("paint", "put colour on");
        paint->add_option("WALL", place, "which wall")->required();
        paint->add_option("--colour,-c", colour, "of the paint")->check(CLI::IsMember({"red", "blue"}));
        paint->add_option("--count", count, "of coats")->capture_default_str();
        app.add_subcommand("leave", ".dots first")->add_flag("--loud", loud, "slam the door");
    }
};

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
}

}  // namespace

TEST_CASE("a man page tells every command with its places, options, words and defaults", "[tool]") {
    const std::string page = man_page(Small().app);
    for (const char* part :
         {".TH UNRAVEL 1", ".SH paint\n", ".SH leave\n", "WALL [options]", "\\-c, \\-\\-colour", "red|blue",
          "of coats (default: 3)", "\\-\\-loud", ".SH EXIT STATUS"}) {
        CAPTURE(part);
        CHECK(has(page, part));
    }
    // Text is no macro, and the only lines that begin with a dot are macros that man(7) has.
    CHECK(has(page, "\\&.dots first"));
    for (std::size_t at = 0; at < page.size(); at = page.find('\n', at) + 1) {
        if (page[at] != '.') continue;
        const std::string macro = page.substr(at + 1, 2);
        CAPTURE(page.substr(at, 20));
        CHECK((macro == "TH" || macro == "SH" || macro == "TP" || macro == "PP" || macro == "B " ||
               macro == "I "));
    }
}

TEST_CASE("completion knows the commands, their options and the words that these take", "[tool]") {
    const std::string script = bash_completion(Small().app);
    CHECK(has(script, "compgen -W \"paint leave --help --version\""));
    CHECK(has(script, "paint:-c|paint:--colour) words=\"red blue\" ;;"));
    CHECK(has(script, "leave) options=\"-h --help --loud\" ;;"));
    CHECK_FALSE(has(script, "WALL"));
}

TEST_CASE("scripts are told the commands' names", "[tool]") {
    CHECK(command_names(Small().app) == "paint\nleave\n");
}
