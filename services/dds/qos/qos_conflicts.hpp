// Reports writers and readers that do not match because the offered QoS is less than the requested one.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fastdds/dds/core/policy/QosPolicies.hpp>

#include "swiftlet/services/dds/qos/duration.hpp"

namespace swiftlet::comms {

// The QoS policies of an endpoint that must be compatible with those of its peer.
struct EndpointQos {
  eprosima::fastdds::dds::ReliabilityQosPolicyKind reliability;
  eprosima::fastdds::dds::DurabilityQosPolicyKind durability;
  eprosima::fastdds::dds::OwnershipQosPolicyKind ownership;
  Duration deadline;
  eprosima::fastdds::dds::LivelinessQosPolicyKind liveliness;
  Duration lease;
  bool without_positive_acks = false;
};

// Returns each incompatible policy with both values: "reliability (offered best effort, requested reliable)";
// empty if all match.
std::string conflicts(const EndpointQos& offered, const EndpointQos& requested);

// Limits log lines to one per second.
class LineLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Returns the line if it may be written now. Otherwise keeps it for due() and drops the line kept before.
  std::optional<std::string> offer(std::string line, Time now);
  // Call it periodically: returns the kept line once it may be written, with the number of dropped lines.
  std::optional<std::string> due(Time now);

 private:
  std::optional<Time> written_;
  std::string kept_;
  int kept_count_ = 0;
};

}  // namespace swiftlet::comms
