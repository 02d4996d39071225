#include "swiftlet/services/dds/qos/profiles.hpp"

#include <cstdint>
#include <string>

#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/qos/duration.hpp"

namespace swiftlet::dds {

bool is_latched(messages::Qos profile) {
  return profile == messages::Qos::kLatched || profile == messages::Qos::kLatchedLarge;
}

bool is_reliable(messages::Qos profile) {
  return is_latched(profile) || profile == messages::Qos::kRequest || profile == messages::Qos::kReply;
}

namespace {

namespace fastdds = eprosima::fastdds::dds;

using std::chrono::milliseconds;

constexpr const char* kLongMessageFlow = "long messages";
constexpr std::int32_t kFragmentBytes = 1400;  // with the headers of RTPS; 1472 fit into a frame
constexpr std::uint64_t kFragmentPeriod_ms = 1;

// A reader that misses a sample learns it from the next heartbeat, and requests it again. Each step may be lost too.
constexpr milliseconds kHeartbeatPeriod{10};
constexpr milliseconds kResponseDelay{1};
constexpr milliseconds kFirstRequestPeriod{20};

bool is_long(messages::Qos profile) {
  return profile == messages::Qos::kLatchedLarge || profile == messages::Qos::kRequest;
}

void set_fragments(fastdds::DataWriterQos& qos) {
  if (kHasFlowControllers) {
    qos.publish_mode().flow_controller_name = kLongMessageFlow;
  } else {
    qos.properties().properties().emplace_back("fastdds.max_message_size", std::to_string(kFragmentBytes));
  }
}

// The policies that are the same for writer and reader, so that they match.
template <class EndpointQos>
void set_common(EndpointQos& qos, messages::Qos profile) {
  qos.reliability().kind =
      is_reliable(profile) ? fastdds::RELIABLE_RELIABILITY_QOS : fastdds::BEST_EFFORT_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = duration(messages::kReliableWriteTimeout);
  qos.durability().kind = is_latched(profile) || profile == messages::Qos::kReply
                              ? fastdds::TRANSIENT_LOCAL_DURABILITY_QOS
                              : fastdds::VOLATILE_DURABILITY_QOS;

  auto& limits = qos.resource_limits();
  limits.max_instances = 1;
  // A mission can be 3000 times as long as a command: memory is allocated as needed, and kept.
  qos.endpoint().history_memory_policy =
      is_long(profile) ? fastrtps::DYNAMIC_REUSABLE_MEMORY_MODE : fastrtps::PREALLOCATED_MEMORY_MODE;
  if (profile == messages::Qos::kRequest || profile == messages::Qos::kReply) {
    const int kept = profile == messages::Qos::kRequest ? messages::kKeptRequests : messages::kKeptReplies;
    qos.history().kind = fastdds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = kept;
    limits.max_samples = kept;
    limits.max_samples_per_instance = kept;
    limits.allocated_samples = 1;
    limits.extra_samples = 2;
  } else {
    // The application may hold one sample besides the last one while the next arrives; the pool never grows.
    qos.history().kind = fastdds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 1;
    limits.max_samples = 2;
    limits.max_samples_per_instance = 1;
    limits.allocated_samples = 2;
    limits.extra_samples = 2;
  }
  qos.data_sharing().off();
}

}  // namespace

std::shared_ptr<eprosima::fastdds::rtps::FlowControllerDescriptor> long_message_flow() {
  auto flow = std::make_shared<eprosima::fastdds::rtps::FlowControllerDescriptor>();
  flow->name = kLongMessageFlow;
  flow->max_bytes_per_period = kFragmentBytes;
  flow->period_ms = kFragmentPeriod_ms;
  return flow;
}

fastdds::DataWriterQos writer_qos(messages::Qos profile) {
  fastdds::DataWriterQos qos;
  set_common(qos, profile);
  // A middleware thread sends long messages in fragments. The calling thread sends all others.
  qos.publish_mode().kind =
      is_long(profile) ? fastdds::ASYNCHRONOUS_PUBLISH_MODE : fastdds::SYNCHRONOUS_PUBLISH_MODE;
  if (is_long(profile)) set_fragments(qos);
  if (is_reliable(profile)) set_repair_times(qos, duration(kHeartbeatPeriod), duration(kResponseDelay));
  return qos;
}

fastdds::DataReaderQos reader_qos(messages::Qos profile) {
  fastdds::DataReaderQos qos;
  set_common(qos, profile);
  if (is_reliable(profile)) set_repair_times(qos, duration(kResponseDelay), duration(kFirstRequestPeriod));
  return qos;
}

}  // namespace swiftlet::dds
