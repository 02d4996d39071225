// Lockstep: publishes the time up to which the plant may advance, no faster than its samples are recorded.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <thread>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Publishes the time up to which a plant that was started with --paused may advance: the goal, but at most
// window_ns beyond the newest sample received from it. The window bounds the samples in transit, so that a
// socket's buffer holds them. Repeats the last message every 0.2 s: the plant ends the run if it receives
// none. Thread-safe.
class SimulationClockPublisher {
 public:
  SimulationClockPublisher(dds::Node& node, std::int64_t window_ns);
  ~SimulationClockPublisher();
  SimulationClockPublisher(const SimulationClockPublisher&) = delete;
  SimulationClockPublisher& operator=(const SimulationClockPublisher&) = delete;

  // Sets the goal. An earlier stamp than the present goal has no effect.
  void up_to(std::int64_t stamp_ns);
  void without_end() { up_to(std::numeric_limits<std::int64_t>::max()); }

  // Call when a sample of this stamp was received.
  void has_come(std::int64_t stamp_ns);

 private:
  void advance();  // call with mutex_ held, as publish()
  void publish();
  void repeat();

  const std::int64_t window_ns_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool end_ = false;
  std::int64_t goal_ns_ = 0;
  std::int64_t come_ns_ = 0;
  messages::msg::SimulationClock clock_;
  dds::Publisher<messages::msg::SimulationClock> publisher_;
  std::thread repeater_;
};

}  // namespace swiftlet::ground
