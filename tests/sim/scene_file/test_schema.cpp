#include "sim/scene_file/schema.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "sim/scene_file/document.hpp"
#include "source_dir.hpp"
#include "tests/json_schema.hpp"

using namespace unravel;
using namespace unravel::sim;
using nlohmann::json;

namespace {

json to_json(const Node& node) {
    json out;
    switch (node.kind) {
        case Node::Kind::flag:
            return node.flag;
        case Node::Kind::integer:
            return node.integer;
        case Node::Kind::number:
            return node.number;
        case Node::Kind::text:
            return node.text;
        case Node::Kind::date:
            return nullptr;
        case Node::Kind::list:
            out = json::array();
            for (const Node& item : node.items) out.push_back(to_json(item));
            return out;
        case Node::Kind::table:
            out = json::object();
            for (const Entry& entry : node.entries) out[entry.key] = to_json(entry.value);
            return out;
    }
    return out;
}

bool valid_text(const std::string& toml) {
    Node root;
    std::vector<SceneProblem> problems;
    REQUIRE(parse_document(toml, root, problems));
    return valid(to_json(root), scene_schema());
}

std::string read(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("every scene that ships is valid by the schema", "[scene]") {
    const std::filesystem::path root = UNRAVEL_SOURCE_DIR;
    CHECK(valid_text(read(root / "tests/scenes/complete.toml")));
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "scenes")) {
        // The table of hard cases names scenes, it is none.
        if (entry.path().extension() != ".toml" || entry.path().filename() == "cases.toml") continue;
        INFO(entry.path().filename());
        CHECK(valid_text(read(entry.path())));
    }
}

TEST_CASE("the schema refuses what the loader refuses in a single value", "[scene]") {
    for (const char* name :
         {"no_cloth", "empty_cloth_list", "unknown_keys", "wrong_types", "absurd", "bad_choices",
          "bad_fraction", "empty_clip", "look", "solids", "tables_and_lists", "wind", "dates"}) {
        INFO(name);
        CHECK(!valid_text(read(std::string(UNRAVEL_SOURCE_DIR "/tests/scenes_bad/") + name + ".toml")));
    }
}

TEST_CASE("the schema tells in which tables a key may stand", "[scene]") {
    using Tables = std::vector<std::string>;
    const std::map<std::string, Tables> tables = tables_of_keys();
    CHECK(tables.at("threshold") == Tables{"[solver]"});
    CHECK(tables.at("gravity") == Tables{"the top of the file"});
    CHECK(tables.at("max_strain") == Tables{"[solver.adaptive]"});
    CHECK(tables.at("release") == Tables{"[[cloth.pin]]"});
    CHECK(!tables.contains("nothing"));
}

TEST_CASE("the schema carries defaults and meanings", "[scene]") {
    const json schema = scene_schema();
    CHECK(schema["properties"]["clip"]["properties"]["fps"]["default"] == 30);
    CHECK(schema["properties"]["solver"]["properties"]["integrator"]["default"] == "adaptive-imex");
    CHECK(!schema["properties"]["gravity"]["description"].get<std::string>().empty());
    CHECK(schema["required"] == json{"cloth"});
}
