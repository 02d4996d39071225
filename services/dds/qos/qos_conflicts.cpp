#include "swiftlet/services/dds/qos/qos_conflicts.hpp"

#include <cstdio>

namespace swiftlet::dds {
namespace {

namespace fastdds = eprosima::fastdds::dds;

const char* name_of(fastdds::ReliabilityQosPolicyKind kind) {
  return kind == fastdds::RELIABLE_RELIABILITY_QOS ? "reliable" : "best effort";
}

const char* name_of(fastdds::DurabilityQosPolicyKind kind) {
  switch (kind) {
    case fastdds::VOLATILE_DURABILITY_QOS:
      return "volatile";
    case fastdds::TRANSIENT_LOCAL_DURABILITY_QOS:
      return "transient local";
    case fastdds::TRANSIENT_DURABILITY_QOS:
      return "transient";
    case fastdds::PERSISTENT_DURABILITY_QOS:
      return "persistent";
  }
  return "unknown";
}

const char* name_of(fastdds::OwnershipQosPolicyKind kind) {
  return kind == fastdds::EXCLUSIVE_OWNERSHIP_QOS ? "exclusive" : "shared";
}

const char* name_of(fastdds::LivelinessQosPolicyKind kind) {
  switch (kind) {
    case fastdds::AUTOMATIC_LIVELINESS_QOS:
      return "automatic";
    case fastdds::MANUAL_BY_PARTICIPANT_LIVELINESS_QOS:
      return "manual by participant";
    case fastdds::MANUAL_BY_TOPIC_LIVELINESS_QOS:
      return "manual by topic";
  }
  return "unknown";
}

std::string name_of(const Duration& time) {
  if (time == fastdds::DeadlineQosPolicy().period) return "none";
  char text[32];
  std::snprintf(text, sizeof text, "%g ms", 1e-6 * static_cast<double>(time.to_ns()));
  return text;
}

void add(std::string& list, const char* policy, const std::string& offered, const std::string& requested) {
  if (!list.empty()) list += ", ";
  list.append(policy)
      .append(" (offered ")
      .append(offered)
      .append(", requested ")
      .append(requested)
      .append(")");
}

}  // namespace

// Same rules as EDP::valid_matching() of Fast DDS.
std::string conflicts(const EndpointQos& offered, const EndpointQos& requested) {
  std::string list;
  if (offered.reliability < requested.reliability)
    add(list, "reliability", name_of(offered.reliability), name_of(requested.reliability));
  if (offered.durability < requested.durability)
    add(list, "durability", name_of(offered.durability), name_of(requested.durability));
  if (offered.ownership != requested.ownership)
    add(list, "ownership", name_of(offered.ownership), name_of(requested.ownership));
  if (offered.deadline > requested.deadline)
    add(list, "deadline", name_of(offered.deadline), name_of(requested.deadline));
  if (offered.liveliness < requested.liveliness)
    add(list, "liveliness", name_of(offered.liveliness), name_of(requested.liveliness));
  if (offered.lease > requested.lease)
    add(list, "liveliness lease", name_of(offered.lease), name_of(requested.lease));
  if (!offered.without_positive_acks && requested.without_positive_acks)
    add(list, "disabled positive acknowledgements", "no", "yes");
  return list;
}

}  // namespace swiftlet::dds
