#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <string>

#include "base/whole_file.hpp"
#include "tests/base/file_size_limit.hpp"
#include "tests/base/temporary_folder.hpp"

using namespace unravel;
namespace fs = std::filesystem;

namespace {

std::string content(const fs::path& file) {
    const auto bytes = read_whole_file(file, 1 << 20);
    return {bytes.begin(), bytes.end()};
}

}  // namespace

TEST_CASE("whole_file_appears_only_at_commit") {
    const TemporaryFolder folder;
    const fs::path target = folder / "stats.csv";
    WholeFile file(target);
    file.write("step,");
    file.write("rvm\n");
    CHECK_FALSE(fs::exists(target));
    file.commit();
    CHECK(content(target) == "step,rvm\n");
    CHECK(folder.entries() == 1);
}

TEST_CASE("whole_file_without_commit_leaves_the_old_content_and_nothing_else") {
    const TemporaryFolder folder;
    const fs::path target = folder / "run.json";
    write_whole_file(target, "old");
    {
        WholeFile file(target);
        file.write("new and unfinished");
        CHECK(folder.entries() == 2);
    }
    CHECK(content(target) == "old");
    CHECK(folder.entries() == 1);
    write_whole_file(target, "new");
    CHECK(content(target) == "new");
}

TEST_CASE("whole_file_works_with_a_bare_name_in_the_current_folder") {
    const TemporaryFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    CHECK_NOTHROW(write_whole_file("bare", "x"));
    fs::current_path(before);
    CHECK(content(folder / "bare") == "x");
}

TEST_CASE("whole_file_errors_name_the_file_and_the_reason") {
    const TemporaryFolder folder;
    write_whole_file(folder / "file", "x");
    fs::create_directory(folder / "sub");
    const struct {
        fs::path target;
        std::string reason;
    } cases[] = {
        {folder / "file" / "frame.png", "Not a directory; a part of the path is a file"},
        {folder / "missing" / "frame.png", "No such file or directory; its folder does not exist"},
        {folder / "sub", "Is a directory"},
        {"/dev/full", "it is a device or a pipe"},
    };
    for (const auto& c : cases) {
        INFO(c.target);
        try {
            write_whole_file(c.target, "x");
            FAIL("written");
        } catch (const OutputError& error) {
            CHECK(error.file() == c.target);
            CHECK_THAT(error.what(), Catch::Contains(c.target.string()) && Catch::Contains(c.reason));
        }
    }
    CHECK(fs::is_character_file("/dev/full"));
}

TEST_CASE("a_disk_that_fills_up_leaves_no_file_and_no_remains") {
    const TemporaryFolder folder;
    const std::string megabyte(1 << 20, 'x');
    {
        const FileSizeLimit limit(1 << 16);
        CHECK_THROWS_AS(write_whole_file(folder / "big", megabyte), OutputError);
        // Small enough to sit in the buffer until commit() flushes it.
        const FileSizeLimit tiny(16);
        CHECK_THROWS_AS(write_whole_file(folder / "small", std::string_view(megabyte).substr(0, 64)),
                        OutputError);
    }
    CHECK(folder.entries() == 0);
}

TEST_CASE("a_killed_writer_leaves_only_a_partial_file_that_can_be_removed") {
    const TemporaryFolder folder;
    write_whole_file(folder / "frame.png", "old");
    const pid_t child = fork();
    if (child == 0) {
        WholeFile file(folder / "frame.png");
        file.write("unfinished");
        raise(SIGKILL);
    }
    REQUIRE(child > 0);
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    CHECK(folder.entries() == 2);
    CHECK(content(folder / "frame.png") == "old");
    CHECK(remove_partial_files(folder.path()) == 1);
    CHECK(folder.entries() == 1);
}

TEST_CASE("remove_partial_files_touches_nothing_else") {
    const TemporaryFolder folder;
    for (const char* name :
         {".hidden", "a.part", ".a.part", ".a.12x.part", "..12.part", ".12.part", "a.12.part"})
        write_whole_file(folder / name, "x");
    fs::create_directory(folder / ".folder.12.part");
    CHECK(remove_partial_files(folder.path()) == 0);
    CHECK(folder.entries() == 8);
    CHECK(remove_partial_files(folder / "missing") == 0);
}

TEST_CASE("read_whole_file_refuses_what_it_should") {
    const TemporaryFolder folder;
    write_whole_file(folder / "four", "1234");
    CHECK(content(folder / "four") == "1234");
    CHECK(read_whole_file(folder / "four", 4).size() == 4);
    CHECK_THROWS_WITH(read_whole_file(folder / "four", 3), Catch::Contains("four: it holds 4 bytes"));
    CHECK_THROWS_WITH(read_whole_file(folder / "none", 4), Catch::Contains("none: No such file"));
    CHECK_THROWS_WITH(read_whole_file(folder.path(), 4), Catch::Contains("not a regular file"));
    REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
    CHECK_THROWS_WITH(read_whole_file(folder / "pipe", 4), Catch::Contains("not a regular file"));
}
