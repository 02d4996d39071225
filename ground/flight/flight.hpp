// Flies one mission over DDS: waits for the vehicle, arms, uploads and starts the mission, monitors it to its
// end.
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

// A flight that was not completed. what() is a sentence with the reason.
class FlightFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Flight {
 public:
  struct Watch {
    std::function<std::optional<std::string>()> exited_process;  // a sentence if a process exited
    std::function<int()> interrupts;                             // number of interrupts by the user
    StartBarrier* barrier = nullptr;                             // null: a single vehicle
  };

  // In lockstep the plant must have been started with --paused.
  Flight(Client& client, const FlightRecord& record, const MissionFile& mission, double planned_duration_s,
         runtime::Clock clock, Watch watch, Progress& progress);

  // Waits for vehicle, pose and control, flies the mission and returns when the rotors are off. With a
  // barrier the mission starts when all vehicles are armed, and a failure of another vehicle lands this one.
  // The first interrupt lands the vehicle, the second returns at once. Throws FlightFailure after landing the
  // vehicle, if that was possible.
  void run();

 private:
  void wait_until_ready();
  void wait_until(const std::function<bool(const View&)>& holds, const std::string& what_not);
  void wait_until_samples_come();
  void wait_until_paused_at(std::int64_t stamp_ns);
  void arm();
  void wait_for_barrier();
  void start_mission();
  void follow();
  [[noreturn]] void fail_silent(const std::string& who);
  void wait_for_last_figures();
  [[noreturn]] void land_and_fail(const std::string& reason);
  void require_alive() const;
  void require_no_interrupt() const;
  void update_progress(const View& view);

  Client& client_;
  const FlightRecord& record_;
  const MissionFile& mission_;
  double planned_duration_s_;
  bool lockstep_;
  std::int64_t paused_at_ns_ = 0;  // lockstep, before the mission
  Watch watch_;
  Progress& progress_;
};

}  // namespace swiftlet::ground
