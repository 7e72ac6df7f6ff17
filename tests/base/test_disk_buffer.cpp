#include "base/disk_buffer.hpp"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <numeric>

#include "tests/base/file_size_limit.hpp"
#include "tests/base/temporary_folder.hpp"

using namespace unravel;

TEST_CASE("a spooled list gives back what it took, and its folder shows nothing", "[files]") {
    const TemporaryFolder folder;
    DiskList<std::uint64_t> list(folder.path());
    std::vector<std::uint64_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), std::uint64_t{7});
    list.append(numbers);
    list.append(std::vector<std::uint64_t>{1, 2, 3});
    REQUIRE(list.size() == 1003);
    CHECK(list.read(5, 2) == std::vector<std::uint64_t>{12, 13});
    CHECK(list.read(999, 4) == std::vector<std::uint64_t>{1006, 1, 2, 3});
    list.replace(std::vector<std::uint64_t>{0, 0});
    CHECK(list.read_all()[1] == 0);
    CHECK(list.read_all()[2] == 9);
    CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a buffer without room or folder says so", "[files]") {
    const TemporaryFolder folder;
    CHECK_THROWS_AS(DiskBuffer(folder.path() / "none"), OutputError);
    DiskBuffer buffer(folder.path());
    const std::vector<std::byte> bytes(5000);
    buffer.append(bytes);
    {
        const FileSizeLimit limit(6000);
        CHECK_THROWS_AS(buffer.append(bytes), OutputError);
    }
    std::vector<std::byte> more(5001);
    CHECK_THROWS_AS(buffer.read(2000, more), InputError);
}
