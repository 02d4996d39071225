#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"

namespace swiftlet::control {

// blend() from the reference into the newest setpoint, worked out once: what is checked is what is flown.
const PolynomialSegment& way_into_setpoint(const SupervisorContext& context);

}  // namespace swiftlet::control
