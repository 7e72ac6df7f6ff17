#pragma once

// The tool is the one library that speaks of both: in its namespace the names of the simulation and of the
// pictures are known without being told where they come from.

namespace unravel::sim {}
namespace unravel::render {}

namespace unravel::tool {
using namespace sim;     // NOLINT(google-build-using-namespace)
using namespace render;  // NOLINT(google-build-using-namespace)
}  // namespace unravel::tool
