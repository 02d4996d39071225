#include "swiftlet/ground/client/simulation_clock.hpp"

#include <algorithm>
#include <chrono>

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kRepeatPeriod{200};

}  // namespace

SimulationClockPublisher::SimulationClockPublisher(dds::Node& node, std::int64_t window_ns)
    : window_ns_(window_ns),
      publisher_(node.publish(messages::topics::kSimulationClock)),
      repeater_([this] { repeat(); }) {}

SimulationClockPublisher::~SimulationClockPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    end_ = true;
  }
  ends_.notify_all();
  repeater_.join();
}

void SimulationClockPublisher::up_to(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  goal_ns_ = std::max(goal_ns_, stamp_ns);
  advance();
}

void SimulationClockPublisher::has_come(std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  come_ns_ = std::max(come_ns_, stamp_ns);
  advance();
}

// Advances by at least a quarter of the window at once, or the rest to the goal: not by a message per sample.
void SimulationClockPublisher::advance() {
  const std::int64_t published_ns = clock_.advance_to_ns();
  const std::int64_t wanted_ns = std::min(goal_ns_, come_ns_ + window_ns_);
  const std::int64_t least_ns = wanted_ns == goal_ns_ ? published_ns + 1 : published_ns + window_ns_ / 4;
  if (wanted_ns < least_ns && clock_.sequence_number() > 0) return;  // the first message starts the plant
  clock_.advance_to_ns(wanted_ns);
  publish();
}

void SimulationClockPublisher::publish() {
  clock_.sequence_number(clock_.sequence_number() + 1);
  publisher_.publish(clock_);
}

void SimulationClockPublisher::repeat() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ends_.wait_for(lock, kRepeatPeriod, [this] { return end_; })) {
    if (clock_.sequence_number() > 0) publish();
  }
}

}  // namespace swiftlet::ground
