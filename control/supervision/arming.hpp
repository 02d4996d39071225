// What must hold before the rotors may turn.
#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// Accepted, or refused with all that stands against it, each with value and limit, as far as a reason is
// long.
Outcome check_arming(const SupervisorContext& context);

}  // namespace swiftlet::control
