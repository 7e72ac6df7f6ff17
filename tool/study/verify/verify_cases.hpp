#pragma once

#include "tool/study/verify/verify_case.hpp"

namespace unravel::tool {

// One function per case, by what it is about: cases_bending.cpp, cases_stretch.cpp, cases_motion.cpp,
// cases_friction.cpp, cases_limit.cpp.
VerifyCase::Result verify_cantilever(bool fast);
VerifyCase::Result verify_tube(bool fast);
VerifyCase::Result verify_moduli(bool fast);
VerifyCase::Result verify_strip(bool fast);
VerifyCase::Result verify_catenary(bool fast);
VerifyCase::Result verify_wave(bool fast);
VerifyCase::Result verify_fall(bool fast);
VerifyCase::Result verify_momentum(bool fast);
VerifyCase::Result verify_terminal(bool fast);
VerifyCase::Result verify_slack(bool fast);
VerifyCase::Result verify_spin(bool fast);
VerifyCase::Result verify_block(bool fast);
VerifyCase::Result verify_incline(bool fast);
VerifyCase::Result verify_capstan(bool fast);
VerifyCase::Result verify_kappa(bool fast);

}  // namespace unravel::tool
