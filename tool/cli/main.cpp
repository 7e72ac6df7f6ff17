#include <algorithm>

#include "tool/cli/commands.hpp"

int main(int argc, char** argv) {
    return unravel::tool::run_command_line({argv + std::min(argc, 1), argv + argc});
}
