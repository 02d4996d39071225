// What must hold before the rotors may turn.
#pragma once

#include "swiftlet/control/supervision/scene.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// Accepted, or refused with all that stands against it, each with value and limit, as far as a reason is
// long.
Outcome check_arming(const Scene& scene);

}  // namespace swiftlet::control
