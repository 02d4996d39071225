#pragma once

#include "swiftlet/control/supervision/scene.hpp"

namespace swiftlet::control {

// blend() from the reference into the newest setpoint, worked out once: what is checked is what is flown.
const PolynomialSegment& way_into_setpoint(const Scene& scene);

}  // namespace swiftlet::control
