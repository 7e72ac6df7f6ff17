#include "tool/base/machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>

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

}  // namespace unravel::tool
