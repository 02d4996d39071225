// The whole controller as pure code: samples and requests in, commands of the vehicle out. No clock, no I/O, no
// threads, no heap allocation after construction. Time is the samples' stamps. One thread calls it.
//
// A step: Observers estimate, Supervisor decides the mode and the setpoint, ControlLaws form the command.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/control/control_laws.hpp"
#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/flight_state.hpp"
#include "swiftlet/control/observers.hpp"
#include "swiftlet/control/supervision/hover_test.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/supervision/supervisor.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"

namespace swiftlet::control {

class FlightController {
 public:
  // Designs all gains. Throws std::invalid_argument with a sentence if the vehicle or the settings break a
  // rule.
  FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings);

  // One step of the inner loop. Returns the command for this sample. A sample that is not finite or not
  // newer than the last is not used, and the last command is repeated. The returned reference stays valid
  // until the next call. Requests and setpoints are accepted or refused in every step, by the mode and the
  // estimate at its sample. A refused one changes nothing. A mission or trajectory must have passed check()
  // of planning/checks.hpp before; setpoints are accepted in holding and setpoint mode.
  const plant::VehicleCommand& on_imu(const plant::ImuSample& sample);
  const plant::VehicleCommand& on_imu(const plant::ImuSample& sample, ClientInputs& clients);

  // The same with the vehicle's own estimate in place of the IMU, of a vehicle that brings it. By which estimate it is flown is
  // a setting; poses correct that of motion capture as with an IMU. Needs a level above actuators: at that one, arming is
  // refused. Attitudes and trajectories are sent in the frame of the vehicle's estimate.
  const plant::VehicleCommand& on_odometry(const plant::OdometrySample& sample);
  const plant::VehicleCommand& on_odometry(const plant::OdometrySample& sample, ClientInputs& clients);

  // The levels that the vehicle accepts, and the one at which it is to be commanded; nullopt: the lowest of them.
  // Without a call the vehicle is commanded at level actuators. Rotors that turn on commands of an accepted level
  // keep it. At a level that the vehicle does not accept, arming is refused.
  //
  // Estimator, supervision, guidance and failsafes work alike at every level; so does the position law except at
  // level trajectory. What the vehicle controls itself is not integrated here: at level trajectory position integral
  // and disturbance observer stand still. Without throttles, the rotors are taken to give the commanded collective
  // thrust, at level trajectory that of the position law.
  void set_levels(plant::ControlLevels accepted, std::optional<plant::ControlLevel> wanted);

  // What the vehicle reports as fault in vehicle_info, from the next step on; empty: none. At other levels than actuators a
  // flight is stopped after 0.5 s of one, and none begins.
  void set_vehicle_fault(const VehicleFault& fault);
  // Why the vehicle must not be armed, a sentence; empty: it may. Has no effect in flight.
  void set_vehicle_refusal(const VehicleFault& refusal) { vehicle_refusal_ = refusal; }

  // What the vehicle reports of its rotors in vehicle_info, from the next step on. At other levels than actuators a take-off begins
  // when they run: a vehicle with an arming of its own starts them later than it is told to. Without a call they run when told to.
  void set_rotors_running(bool running) { rotors_running_ = running; }

  // The vehicle was restarted: the next sample is the first of its new run, whatever its stamp. Rotors that were to run are
  // stopped until they are armed again.
  void restart_vehicle() { vehicle_restarted_ = true; }

  // The command that the vehicle obeyed when it took the next sample, as it reports with it. Without a call, or without that report, it
  // is taken to obey the newest one: over a link with delay the lift that is learnt is then wrong.
  // of_this: it is one of this controller, or not reported, or this is a standby. Arming is done when it is; if it is not within
  // 1 s, it ends.
  void set_obeyed(const plant::ObeyedCommand& obeyed, bool of_this = true) {
    observers_.set_obeyed(obeyed);
    obeyed_ = of_this;
  }

  void on_pose(const plant::PoseSample& sample) {
    observers_.on_pose(sample, laws_.rotor_state());
    hover_test_.on_pose(sample);
  }
  void on_battery(const plant::BatterySample& sample) { observers_.on_battery(sample); }
  void on_rotor_speeds(const plant::RotorSpeedSample& sample) { observers_.on_rotor_speeds(sample); }
  // Returns false if the link-loss failsafe is on for too many other clients already.
  bool on_ground_heartbeat(const GroundHeartbeat& heartbeat) {
    return supervisor_.ground_heartbeat(heartbeat);
  }

  // While simulated time stands still: answers clients as on_imu() does, at the last sample.
  void answer(ClientInputs& clients);
  Outcome request(const Request& request);
  Outcome on_setpoint(const Setpoint& setpoint);

  // The state of the flight. Another controller of the same vehicle and settings adopts it and continues in
  // its next step, with the gains in force and a change of them under way. The mission and trajectory being
  // flown are passed separately, as in Supervisor::adopt().
  FlightState state() const;
  void adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory);
  // True if the vehicle flies, by accelerometer and rotor speeds: nothing but the rotors carries it.
  bool detects_airborne() const { return observers_.airborne(situation()); }
  // Brings a vehicle that is already flying into hold. Returns false without a pose, and changes nothing.
  bool engage_in_flight();

  // Values of the last step.
  const Estimate& estimate() const { return observers_.estimate(); }
  ErrorState estimate_deviation() const { return observers_.estimate_deviation(); }
  const Reference& reference() const { return reference_; }
  const AttitudeSetpoint& attitude_setpoint() const { return laws_.attitude_setpoint(); }
  const Status& status() const { return status_; }
  const ControlGains& gains() const { return laws_.gains(); }  // in force
  // Current status of the requests that were accepted last.
  const RequestStatuses& requests() const { return supervisor_.requests(); }

 private:
  FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings,
                   const ControlDesign& design);

  void begin_anew_if_restarted(std::int64_t stamp_ns);
  const plant::VehicleCommand& step(const plant::ImuSample& sample, bool usable, ClientInputs& clients);
  const plant::VehicleCommand& answer_sample(const plant::ImuSample& sample);
  Situation situation() const;
  SupervisorInputs inputs() const;
  void test_hover(double dt_s);
  void begin_gain_change(const Request& request, const Outcome& outcome);
  void begin_gain_changes(const ClientInputs& clients);
  void report(const SupervisorInputs& inputs);

  FailsafeSettings failsafe_;
  Observers observers_;
  Supervisor supervisor_;
  ControlLaws laws_;
  HoverTest hover_test_;
  ClientInputs no_clients_;  // stays empty

  plant::ControlLevel level_ = plant::ControlLevel::kActuators;
  plant::ControlLevels accepted_levels_ = plant::ControlLevel::kActuators;
  VehicleFault vehicle_fault_{};
  VehicleFault vehicle_refusal_{};
  std::int64_t vehicle_fault_since_ns_ = 0;  // of the first step with it
  bool rotors_running_ = true;               // as the vehicle reports
  bool obeyed_ = true;                       // this controller, or not reported
  std::int64_t obeyed_ns_ = 0;               // stamp of the last step with it
  bool vehicle_restarted_ = false;           // with the next sample
  std::uint32_t resets_seen_ = 0;            // resets of the estimate that the supervisor has processed
  std::int64_t saturated_ns_ = -1;           // of the last saturated command; -1: none
  Reference reference_;
  Status status_;
};

}  // namespace swiftlet::control
