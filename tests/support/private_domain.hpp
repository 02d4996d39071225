// Settings of a node in a domain that the test has for itself.
#pragma once

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::tests {

// name: of the process, such as "control". Only over the loopback interface.
inline dds::NodeSettings settings_of(const char* name, const dds::DomainLock& lock) {
  dds::NodeSettings settings;
  settings.name = name;
  settings.domain = lock.domain();
  return settings;
}

}  // namespace swiftlet::tests
