// Settings of a node in a domain that the test has for itself.
#pragma once

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

// name: of the process, such as "control". Only over the loopback interface.
inline comms::NodeSettings settings_of(const char* name, const comms::DomainLock& lock) {
  comms::NodeSettings settings;
  settings.name = name;
  settings.domain = lock.domain();
  return settings;
}

}  // namespace swiftlet::tests
