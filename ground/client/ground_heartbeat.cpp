#include "swiftlet/ground/client/ground_heartbeat.hpp"

#include <chrono>
#include <thread>

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kPeriodNs = 50'000'000;
// A controller that misses the last heartbeat takes the end of this tool for a lost link. On a network that loses half
// of all datagrams, so many are all lost once in a thousand times.
constexpr int kLastHeartbeats = 10;
constexpr std::chrono::milliseconds kLastHeartbeatPeriod{10};

}  // namespace

GroundHeartbeatPublisher::GroundHeartbeatPublisher(dds::Node& node, std::uint64_t client)
    : publisher_(node.publish(messages::topics::kGroundLink)) {
  heartbeat_.client(client);
  publish(true);
}

GroundHeartbeatPublisher::~GroundHeartbeatPublisher() {
  for (int i = 0; i < kLastHeartbeats; ++i) {
    if (i > 0) std::this_thread::sleep_for(kLastHeartbeatPeriod);
    publish(false);
  }
}

void GroundHeartbeatPublisher::telemetry(std::int64_t stamp_ns) {
  const std::int64_t elapsed_ns = stamp_ns - heartbeat_.stamp_ns();
  if (elapsed_ns >= 0 && elapsed_ns < kPeriodNs) return;  // < 0: the vehicle was restarted
  heartbeat_.stamp_ns(stamp_ns);
  publish(true);
}

void GroundHeartbeatPublisher::publish(bool depends) {
  heartbeat_.sequence_number(heartbeat_.sequence_number() + 1);
  heartbeat_.depends(depends);
  publisher_.publish(heartbeat_);
}

}  // namespace swiftlet::ground
