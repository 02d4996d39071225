#include "swiftlet/services/dds/qos/qos_conflict_log.hpp"

#include <iterator>

#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::comms {

void QosConflictLog::note(const Guid& own, const Guid& other, const std::string& topic,
                          const std::string& process, const char* consequence, const std::string& policies,
                          Time now) {
  noted_.emplace(own, other);
  const auto line = lines_.offer(
      topic + ": " + process + " " + consequence + ", their QoS is incompatible: " + policies, now);
  if (line) runtime::log_warning("{}", *line);
}

void QosConflictLog::write_due(Time now) {
  if (const auto line = lines_.due(now)) runtime::log_warning("{}", *line);
}

void QosConflictLog::forget(const GuidPrefix& participant) {
  for (auto it = noted_.begin(); it != noted_.end();)
    it = it->second.guidPrefix == participant ? noted_.erase(it) : std::next(it);
}

}  // namespace swiftlet::comms
