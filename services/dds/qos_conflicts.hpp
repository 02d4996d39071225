// Peers that are not heard, or do not hear, because a writer offers less than a reader asks for.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fastdds/dds/core/policy/QosPolicies.hpp>

namespace swiftlet::comms {

// What of an endpoint's QoS a peer must agree to.
struct EndpointQos {
  eprosima::fastdds::dds::ReliabilityQosPolicyKind reliability;
  eprosima::fastdds::dds::DurabilityQosPolicyKind durability;
  eprosima::fastdds::dds::OwnershipQosPolicyKind ownership;
  eprosima::fastrtps::Duration_t deadline;
  eprosima::fastdds::dds::LivelinessQosPolicyKind liveliness;
  eprosima::fastrtps::Duration_t lease;
  bool without_positive_acks = false;
};

// Of a WriterQos or a ReaderQos.
template <class Qos>
EndpointQos endpoint_qos(const Qos& qos) {
  return {qos.m_reliability.kind,
          qos.m_durability.kind,
          qos.m_ownership.kind,
          qos.m_deadline.period,
          qos.m_liveliness.kind,
          qos.m_liveliness.lease_duration,
          qos.m_disablePositiveACKs.enabled};
}

// Each policy for which they do not match, with both values: "reliability (offered best effort, asked for
// reliable)"; empty if they match.
std::string conflicts(const EndpointQos& offered, const EndpointQos& requested);

// Lines for a log of which at most one a second is written.
class LineLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // The line, if it may be written now. Else it is kept for due(), in the place of one that was kept before.
  std::optional<std::string> offer(std::string line, Time now);
  // Again and again: what was kept, once it may be written, and how many others there were.
  std::optional<std::string> due(Time now);

 private:
  std::optional<Time> written_;
  std::string kept_;
  int kept_count_ = 0;
};

}  // namespace swiftlet::comms
