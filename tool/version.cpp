#include "tool/version.hpp"

namespace unravel {

const char* version() {
    return UNRAVEL_VERSION;
}

}  // namespace unravel
