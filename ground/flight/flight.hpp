// One mission flown from the ground: wait for the vehicle, arm, upload, follow it down.
#pragma once

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/flight/start_barrier.hpp"
#include "swiftlet/ground/terminal/progress.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::ground {

// Why a flight did not come to its end. what() is a sentence.
class FlightFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Flight {
 public:
  struct Watch {
    std::function<std::optional<std::string>()> exited_process;  // a process that died, as a sentence
    std::function<int()> interrupts;                             // how often the user asked to end
    StartBarrier* barrier = nullptr;                             // with others; null: alone
  };

  // In lockstep the plant is one that was started paused.
  Flight(Client& client, const FlightRecord& record, const MissionFile& mission, double planned_duration_s,
         runtime::Clock clock, Watch watch, Progress& progress);

  // Until vehicle, pose and control are there, the mission is flown, and the rotors are off. Throws
  // FlightFailure; the vehicle has then been landed where that was possible. The first interrupt lands it,
  // the second gives up at once. StartBarrier with others the mission begins when all are armed, and a failure of
  // another one lands this one.
  void run();

 private:
  void wait_until_ready();
  void wait_until(const std::function<bool(const View&)>& holds, const std::string& what_not);
  void wait_until_samples_come();
  void wait_until_paused_at(std::int64_t stamp_ns);
  void arm();
  void wait_for_the_others();
  void start_mission();
  void follow();
  [[noreturn]] void fail_of_silence(const std::string& who);
  void wait_for_last_figures();
  [[noreturn]] void bring_down(const std::string& reason);
  void require_alive() const;
  void require_no_interrupt() const;
  void show(const View& view);

  Client& client_;
  const FlightRecord& record_;
  const MissionFile& mission_;
  double planned_duration_s_;
  bool lockstep_;
  std::int64_t paused_at_ns_ = 0;  // in lockstep, before the mission
  Watch watch_;
  Progress& progress_;
};

}  // namespace swiftlet::ground
