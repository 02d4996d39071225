#include "swiftlet/ground/client/context.hpp"

#include "swiftlet/ground/client/discovery.hpp"

namespace swiftlet::ground {

std::vector<std::string> Context::discovered_vehicles() const {
  return vehicles_of(participant_.topics_seen());
}

}  // namespace swiftlet::ground
