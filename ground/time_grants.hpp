// Lockstep: lets simulated time pass, and keeps the plant from running away from what is recorded of it.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "services/comms/node.hpp"

namespace swiftlet::ground {

// A plant that was started with --paused goes as far as it is granted. The last grant is said again and
// again: the plant ends the run when it hears nothing more. Any thread may call it.
class TimeGrants {
 public:
  explicit TimeGrants(comms::Node& node);
  ~TimeGrants();
  TimeGrants(const TimeGrants&) = delete;
  TimeGrants& operator=(const TimeGrants&) = delete;

  // Up to this stamp, if it is later than the last.
  void up_to(std::int64_t stamp_ns);

  // From now on a little more than what telemetry() has told: few enough samples under way that none is lost.
  void follow_telemetry(std::int64_t now_ns);
  // Telemetry of this stamp has come.
  void telemetry(std::int64_t stamp_ns);

 private:
  void publish();  // with the lock held
  void repeat();

  std::mutex mutex_;
  std::condition_variable ends_;
  bool end_ = false;
  bool follows_ = false;
  comms::msg::SimulationClock clock_;
  comms::Publisher<comms::msg::SimulationClock> publisher_;
  std::thread repeater_;
};

}  // namespace swiftlet::ground
