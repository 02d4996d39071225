// Settings of a node of a test, in its own domain.
#pragma once

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds::fixtures {

inline NodeSettings settings(const DomainLock& lock, const char* name) {
  NodeSettings settings;
  settings.name = name;
  settings.domain = lock.domain();
  return settings;
}

}  // namespace swiftlet::dds::fixtures
