// Logs which endpoints of other processes do not match those of this one.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/qos/qos_conflicts.hpp"

namespace swiftlet::comms {

struct RemoteEndpoint {
  std::string topic;
  EndpointQos qos;
};
using RemoteEndpoints = std::map<rtps::GUID_t, RemoteEndpoint>;

// Logs each pair of endpoints once, and at most one line a second. Not thread-safe.
class QosConflictLog {
 public:
  using Guid = rtps::GUID_t;
  using GuidPrefix = rtps::GuidPrefix_t;
  using Time = std::chrono::steady_clock::time_point;

  // process: of the other endpoint, such as "'plant' (01.0f...)"; consequence: "is not received"; policies: those
  // that are incompatible.
  void note(const Guid& own, const Guid& other, const std::string& topic, const std::string& process,
            const char* consequence, const std::string& policies, Time now);
  bool has_noted(const Guid& own, const Guid& other) const { return noted_.count({own, other}) > 0; }
  void write_due(Time now);  // call it periodically

  void forget(const GuidPrefix& participant);
  void clear() { noted_.clear(); }

 private:
  std::set<std::pair<Guid, Guid>> noted_;  // own endpoint, other endpoint
  LineLimit lines_;
};

}  // namespace swiftlet::comms
