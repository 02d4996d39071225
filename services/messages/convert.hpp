// Converts between messages and the plain structs of plant and control. Received messages are validated:
// numbers finite, counts and enumerations in range, quaternions of unit length. Whether a request can be
// flown is checked elsewhere (control/planning/checks.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/control/flight_state.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/control/types/settings_request.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::messages {

// The fault of an invalid message: a sentence with field, value and limit; empty for a valid one. No heap.
struct Fault {
  char text[160] = {};
  explicit operator bool() const { return text[0] != '\0'; }
};

// The content of controller_state: what a controller reports to the others.
struct ControllerReport {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  std::uint64_t controller = 0;
  int failover_priority = 0;
  std::uint32_t term = 0;
  bool active = false;
  bool ready = false;  // it can take over the flight
  // Valid for an active controller only.
  control::FlightState flight;
  int rotor_count = 0;
};

// Validates in and converts it into out. On a fault, out is unchanged. The functions of samples do not
// allocate.
Fault from_message(const msg::Imu& in, plant::ImuSample& out);
plant::ObeyedCommand from_message(const msg::ObeyedCommand& in);
plant::LockstepInputs from_message(const msg::LockstepInputs& in);
Fault from_message(const msg::VehicleOdometry& in, plant::OdometrySample& out);
Fault from_message(const msg::MocapPose& in,
                   plant::PoseSample& out);  // ignores the pose of an untracked sample
Fault from_message(const msg::Battery& in, plant::BatterySample& out);
Fault from_message(const msg::RotorSpeeds& in, plant::RotorSpeedSample& out);
Fault from_message(const msg::ActuatorCommand& in, plant::ActuatorCommand& out);
Fault from_message(const msg::RatesSetpoint& in, plant::RatesSetpoint& out);
Fault from_message(const msg::AttitudeSetpoint& in, plant::AttitudeSetpoint& out);
Fault from_message(const msg::TrajectorySetpoint& in, plant::TrajectorySetpoint& out);
Fault from_message(const msg::GroundTruth& in, plant::TruthSample& out);
Fault from_message(const msg::Setpoint& in, control::Setpoint& out);
Fault from_message(const msg::GroundLink& in, control::GroundHeartbeat& out);
Fault from_message(const msg::Command& in, control::Request& out);
Fault from_message(const msg::Mission& in, control::Mission& out);
Fault from_message(const msg::Trajectory& in, control::Trajectory& out);
Fault from_message(const msg::ControllerState& in, ControllerReport& out);
Fault from_message(const msg::ControlSettings& in, control::SettingsRequest& out);

msg::Imu to_message(const plant::ImuSample& in);
msg::ObeyedCommand to_message(const plant::ObeyedCommand& in);
msg::LockstepInputs to_message(const plant::LockstepInputs& in);
msg::VehicleOdometry to_message(const plant::OdometrySample& in);
msg::MocapPose to_message(const plant::PoseSample& in);
msg::Battery to_message(const plant::BatterySample& in);
msg::RotorSpeeds to_message(const plant::RotorSpeedSample& in);
msg::ActuatorCommand to_message(const plant::ActuatorCommand& in);
msg::RatesSetpoint to_message(const plant::RatesSetpoint& in);
msg::AttitudeSetpoint to_message(const plant::AttitudeSetpoint& in);
msg::TrajectorySetpoint to_message(const plant::TrajectorySetpoint& in);
msg::GroundTruth to_message(const plant::TruthSample& in);
msg::Setpoint to_message(const control::Setpoint& in);
msg::ControllerState to_message(const ControllerReport& in);
msg::Estimate to_message(const control::Estimate& in, const control::ErrorState& standard_deviation,
                         double pose_age_s);  // the caller sets sequence_number
msg::Reference to_message(const control::Reference& in, const control::AttitudeSetpoint& setpoint,
                          control::Mode mode);
// The caller sets client and id. For a Command, in.kind must not be that of a mission or trajectory.
msg::Command to_message(const control::Request& in);
msg::Mission to_message(const control::Mission& in);
msg::Trajectory to_message(const control::Trajectory& in);
msg::ControlSettings to_message(const control::SettingsRequest& in);
msg::ControlGains to_message(const control::ControlGains& in);
msg::RequestStatus to_message(const control::RequestStatus& in);
// What the status of a controller says, without stamp, number, and what only its process knows: timing, links, requests.
msg::ControlStatus to_message(const control::Status& in, const control::ControlGains& gains,
                              const control::FailsafeSettings& thresholds);
msg::MissionStatus to_message(const control::MissionProgress& in);
// RequestStatus::ended_by, and likewise in ControllerState.
std::uint8_t kind_of_end(const control::RequestStatus& in);

}  // namespace swiftlet::messages
