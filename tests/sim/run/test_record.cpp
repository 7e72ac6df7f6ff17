// Frame records: exact round trips, and damage that is noticed.

#include <unistd.h>
#include <catch2/catch.hpp>
#include <fstream>

#include "base/file_errors.hpp"
#include "tests/sim/scenes.hpp"

using namespace unravel;
using namespace unravel::sim;
using namespace unravel::testing;

namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("unravel_record_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() { fs::remove_all(path); }
};

std::vector<char> bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

FrameRecord some_record(Simulation& simulation) {
    run_steps(simulation, 6);
    return next_record(simulation);
}

}  // namespace

TEST_CASE("a record reads back to the same bytes and state") {
    const Folder folder;
    Simulation simulation = start_simulation(drape(15));
    const FrameRecord record = some_record(simulation);
    REQUIRE_FALSE(record.state.contacts.empty());
    write_record(folder.path / "a", 77, record);
    const FrameRecord back = read_record(folder.path / "a", 77, 225, simulation.model.springs.size());
    CHECK(state_hash(back.state) == state_hash(record.state));
    CHECK(back.component == record.component);
    CHECK(back.springs == record.springs);
    CHECK(back.state.contacts.size() == record.state.contacts.size());
    write_record(folder.path / "b", 77, back);
    CHECK(bytes_of(folder.path / "a") == bytes_of(folder.path / "b"));
}

TEST_CASE("a record that is damaged, cut short or of another scene is refused") {
    const Folder folder;
    Simulation simulation = start_simulation(drape(15));
    const FrameRecord record = some_record(simulation);
    const std::size_t springs = simulation.model.springs.size();
    const fs::path file = folder.path / "a";
    write_record(file, 77, record);
    CHECK_THROWS_AS(read_record(file, 78, 225, springs), InputError);
    CHECK_THROWS_AS(read_record(file, 77, 224, springs), InputError);
    CHECK_THROWS_AS(read_record(file, 77, 225, springs + 1), InputError);
    const std::vector<char> whole = bytes_of(file);
    for (std::size_t cut = 0; cut < whole.size(); cut += whole.size() / 40 + 1) {
        std::ofstream(file, std::ios::binary).write(whole.data(), static_cast<std::streamsize>(cut));
        CHECK_THROWS_AS(read_record(file, 77, 225, springs), InputError);
    }
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 40 + 1) {
        std::vector<char> flipped = whole;
        flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
        std::ofstream(file, std::ios::binary)
            .write(flipped.data(), static_cast<std::streamsize>(flipped.size()));
        CHECK_THROWS_AS(read_record(file, 77, 225, springs), InputError);
    }
}
