#include "tool/base/version.hpp"

namespace unravel::tool {

const char* version() {
    return UNRAVEL_VERSION;
}

}  // namespace unravel::tool
