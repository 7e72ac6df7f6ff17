#include "tool/base/machine.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

namespace unravel::tool {

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string processor_name() {
    std::string name;
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; name.empty() && std::getline(info, line);) {
        const std::size_t colon = line.find(": ");
        if (line.starts_with("model name") && colon != line.npos) name = line.substr(colon + 2);
    }
    utsname system{};
    if (name.empty() && ::uname(&system) == 0) name = system.machine;
    std::replace(name.begin(), name.end(), ',', ' ');
    return name;
}

namespace {

// The number behind a name in one of the kernel's files of "name: number kB"; 0 where there is none.
double kernel_bytes(const char* file, std::string_view name) {
    std::ifstream info(file);
    for (std::string line; std::getline(info, line);)
        if (line.starts_with(name)) return 1024.0 * std::strtod(line.c_str() + name.size(), nullptr);
    return 0;
}

// The number that a file consists of; infinite where it says "max" or is not there.
double number_in(const char* file) {
    std::ifstream in(file);
    double number = 0;
    return in >> number ? number : std::numeric_limits<double>::infinity();
}

}  // namespace

std::string MemoryRoom::told() const {
    return fmt::format("{} leaves {:.0f} MB", limit, bytes / 1e6);
}

MemoryRoom memory_room() {
    MemoryRoom room{kernel_bytes("/proc/meminfo", "MemAvailable:"), "this machine"};
    const auto consider = [&](double bytes, const char* limit) {
        if (bytes < room.bytes) room = {std::max(bytes, 0.0), limit};
    };
    // What a control group counts as taken holds the files that it has read, which give way.
    const double given = number_in("/sys/fs/cgroup/memory.max"),
                 taken = number_in("/sys/fs/cgroup/memory.current");
    double files = 0;
    std::ifstream stat("/sys/fs/cgroup/memory.stat");
    for (std::string name, value; stat >> name >> value;)
        if (name == "inactive_file" || name == "active_file") files += std::strtod(value.c_str(), nullptr);
    if (std::isfinite(given) && std::isfinite(taken)) consider(given - taken + files, "this container");
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        consider(static_cast<double>(limit.rlim_cur) - kernel_bytes("/proc/self/status", "VmSize:"),
                 "ulimit -v");
    return room;
}

std::string thread_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NPROC, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
        return fmt::format("ulimit -u allows this user {} in all: raise it", limit.rlim_cur);
    return "this machine or container allows no more";
}

}  // namespace unravel::tool
