#include "swiftlet/ground/client/context.hpp"

#include "swiftlet/ground/client/vehicles_seen.hpp"

namespace swiftlet::ground {

std::vector<std::string> Context::vehicles_seen() const { return vehicles_of(participant_.topics_seen()); }

}  // namespace swiftlet::ground
