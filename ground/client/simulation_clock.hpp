// Lockstep: lets simulated time pass, and keeps the plant from running away from what is recorded of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <thread>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// A plant that was started with --paused goes as far as it is granted: to a goal, but never further than a
// window beyond what has come from it, few enough samples under way that a socket's buffer holds them all.
// The last grant is said again and again: the plant ends the run when it hears nothing more. Any thread may
// call it.
class SimulationClockPublisher {
 public:
  SimulationClockPublisher(comms::Node& node, std::int64_t window_ns);
  ~SimulationClockPublisher();
  SimulationClockPublisher(const SimulationClockPublisher&) = delete;
  SimulationClockPublisher& operator=(const SimulationClockPublisher&) = delete;

  // The goal; not before the last one.
  void up_to(std::int64_t stamp_ns);
  void without_end() { up_to(std::numeric_limits<std::int64_t>::max()); }

  // What the vehicle was or did at this stamp has come.
  void has_come(std::int64_t stamp_ns);

 private:
  void grant();  // with the lock held, as publish()
  void publish();
  void repeat();

  const std::int64_t window_ns_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool end_ = false;
  std::int64_t goal_ns_ = 0;
  std::int64_t come_ns_ = 0;
  comms::msg::SimulationClock clock_;
  comms::Publisher<comms::msg::SimulationClock> publisher_;
  std::thread repeater_;
};

}  // namespace swiftlet::ground
