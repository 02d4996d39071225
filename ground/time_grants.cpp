#include "ground/time_grants.hpp"

#include <chrono>

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kRepeatPeriod{200};
// 50 samples of ground truth at 500 Hz, which a socket's default buffer holds three times over.
constexpr std::int64_t kWindowNs = 100'000'000;

}  // namespace

TimeGrants::TimeGrants(comms::Node& node)
    : publisher_(node.publish(comms::topics::kSimulationClock)), repeater_([this] { repeat(); }) {}

TimeGrants::~TimeGrants() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ends_.notify_all();
  repeater_.join();
}

void TimeGrants::up_to(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (stamp_ns <= clock_.advance_to_ns()) return;
  clock_.advance_to_ns(stamp_ns);
  publish();
}

void TimeGrants::follow_telemetry(std::int64_t now_ns) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    follows_ = true;
  }
  telemetry(now_ns);
}

void TimeGrants::telemetry(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t wanted_ns = stamp_ns + kWindowNs;
  if (!follows_ || wanted_ns < clock_.advance_to_ns() + kWindowNs / 4) return;
  clock_.advance_to_ns(wanted_ns);
  publish();
}

void TimeGrants::publish() {
  clock_.sequence_number(clock_.sequence_number() + 1);
  publisher_.publish(clock_);
}

void TimeGrants::repeat() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_.wait_for(lock, kRepeatPeriod, [this] { return end_; })) {
    if (clock_.sequence_number() > 0) publish();
  }
}

}  // namespace swiftlet::ground
