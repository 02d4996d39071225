// A vehicle on the network, as the mission runner flies it (simulation/mission_runner.hpp).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/flight/lockstep_time.hpp"
#include "swiftlet/ground/flight/start_barrier.hpp"
#include "swiftlet/io/command_line/progress.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/simulation/mission_runner.hpp"

namespace swiftlet::ground {

// Lands the vehicle where a flight fails in the air and landing is possible, but not an attached one that another
// ground tool has taken over. The first interrupt lands it, the second
// ends the flight at once. Together with other vehicles all missions start at one time of a common clock, when all are
// armed, and the failure of another one lands this one. The common clock is the simulated time, in real time the monotonic
// clock of this host.
class NetworkTransport final : public simulation::MissionTransport {
 public:
  struct Watch {
    std::function<std::optional<std::string>()> exited_process;  // a process that ended, as a sentence
    std::function<int()> interrupts;                             // by the user, so far
    std::function<bool()> is_recorded;  // whether the recorder receives the samples of the vehicle
    StartBarrier* barrier = nullptr;    // with other vehicles; null: alone
    bool attached = false;              // to processes that outlive the flight
    double speed = 1.0;                 // of the vehicle's clock in real time
  };

  // In lockstep the plant was started paused.
  NetworkTransport(const std::shared_ptr<Client>& client, const io::MissionFile& mission,
                   runtime::Clock clock, Watch watch, io::Progress& progress);
  ~NetworkTransport() override;

  void wait_until_ready() override;
  Reply arm() override;
  void wait(std::int64_t duration_ns, const std::string& reason) override;
  void wait_for_other_vehicles() override;
  Reply start_mission() override;
  void advance() override;
  Status status() const override;
  std::string abort_reason() const override;
  [[noreturn]] void abandon(const std::string& reason) override;

  // After the flight: plant and control publish its timing figures with their next status.
  void wait_for_last_figures();

  // Time of the vehicle's clock since it was ready, in lockstep since stamp 0; 0 before.
  double vehicle_s() const;

 private:
  static constexpr double kSilenceS = 3.0;  // without control_status or motion

  // When samples stop to come.
  class Silence {
   public:
    bool lasts(std::uint64_t sample_count, double limit_s = kSilenceS);

   private:
    Clock::time_point polled_ = Clock::now();
    std::uint64_t count_ = 0;
    double lasted_s_ = 0.0;
  };

  std::int64_t at_vehicle_rate(std::int64_t host_ns) const;
  // The clocks drift while the other vehicles are awaited: the offset is measured until the start is chosen.
  void update_clock_offset(clocks::ClockClient& vehicle_clock);
  void learn_clock_offset(clocks::ClockClient& vehicle_clock);
  void wait_until(const std::function<bool(const View&)>& holds, const std::string& what_not);
  void wait_until_recorded();
  void wait_until_paused_at(std::int64_t stamp_ns);
  [[noreturn]] void fail_silent(const std::string& who);
  bool publishes_truth() const;
  void require_alive() const;
  void require_alive_in_flight();
  void require_no_interrupt() const;
  Result land_after_abort();
  void update_progress(const View& view);
  void yield_to_other_tool(const View& view);
  bool lands(const Result& landing) const;
  bool is_taken_over(const Result& landing) const;

  Client& client_;
  Vehicle vehicle_;  // on the client; stops waiting for answers when the flight ends
  const io::MissionFile& mission_;
  bool lockstep_;
  std::int64_t paused_at_ns_ = 0;     // in lockstep, before the mission
  std::optional<LockstepTime> time_;  // in lockstep, from its start on
  // In real time: the vehicle's clock minus the monotonic one of this host at its speed.
  std::optional<std::int64_t> clock_offset_ns_;
  std::optional<std::int64_t> ready_ns_;          // stamps of the vehicle
  std::optional<std::int64_t> mission_began_ns_;  // for the progress
  std::int64_t start_ns_ = 0;                     // on the vehicle's clock; 0: at once
  Result armed_;                                  // the answer to the last request to arm
  Result start_;                                  // the answer to the request that started the mission
  Watch watch_;
  io::Progress& progress_;
  Silence control_silence_, vehicle_silence_, sample_silence_;
};

}  // namespace swiftlet::ground
