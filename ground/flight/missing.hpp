// What a flight still waits for before it can begin.
#pragma once

#include <string>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

// The topics that are still missing; empty if all have arrived.
std::string missing(const View& view, bool has_truth);

// The first missing process; empty if all are discovered. In lockstep samples arrive only when time advances.
std::string missing_peer(const View& view);

}  // namespace swiftlet::ground
