// The arming checks: conditions for the rotors to start.
#pragma once

#include "swiftlet/control/supervision/supervisor_context.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// Accepts, or refuses with a list of all failed checks, each with value and limit, as far as they fit into
// the reason.
Outcome check_arming(const SupervisorContext& context);

}  // namespace swiftlet::control
