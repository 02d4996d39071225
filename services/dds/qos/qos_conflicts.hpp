// Reports writers and readers that do not match because the offered QoS is less than the requested one.
#pragma once

#include <string>

#include <fastdds/dds/core/policy/QosPolicies.hpp>

#include "swiftlet/services/dds/qos/duration.hpp"

namespace swiftlet::dds {

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

}  // namespace swiftlet::dds
