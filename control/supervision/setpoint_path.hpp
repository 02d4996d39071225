#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

// The blend() from the reference to the newest setpoint. It is computed once, so the checked path is the
// flown one.
const PolynomialSegment& path_to_setpoint(const SupervisorContext& context);

}  // namespace swiftlet::control
