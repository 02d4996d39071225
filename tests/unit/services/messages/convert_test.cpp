#include "swiftlet/services/messages/convert.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::messages::fixtures::convert_test {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A message converted to the struct and back is equal.
template <class Plain, class Message>
void expect_same(const Message& message) {
  Plain plain;
  const Fault fault = from_message(message, plain);
  EXPECT_STREQ(fault.text, "");
  EXPECT_TRUE(to_message(plain) == message);
}

TEST(Convert, RoundTripPreservesMessages) {
  expect_same<plant::ImuSample>(example<msg::Imu>());
  expect_same<plant::OdometrySample>(example<msg::VehicleOdometry>());
  expect_same<plant::PoseSample>(example<msg::MocapPose>());
  expect_same<plant::BatterySample>(example<msg::Battery>());
  expect_same<plant::RotorSpeedSample>(example<msg::RotorSpeeds>());
  expect_same<plant::ActuatorCommand>(example<msg::ActuatorCommand>());
  expect_same<plant::RatesSetpoint>(example<msg::RatesSetpoint>());
  expect_same<plant::AttitudeSetpoint>(example<msg::AttitudeSetpoint>());
  expect_same<plant::TrajectorySetpoint>(example<msg::TrajectorySetpoint>());
  expect_same<plant::TruthSample>(example<msg::GroundTruth>());
  expect_same<control::Setpoint>(example<msg::Setpoint>());
  expect_same<ControllerReport>(example<msg::ControllerState>());
  expect_same<control::Request>(to_message(request()));
  expect_same<control::Mission>(
      to_message(mission(control::kMaxMissionItems, control::kMaxTrajectorySegments)));
  expect_same<control::SettingsRequest>(to_message(settings_request()));
  expect_same<control::Trajectory>(to_message(trajectory(control::kMaxTrajectorySegments)));
}

TEST(Convert, CommandsOfAllLevelsCarryTheSameHeader) {
  const plant::CommandHeader sent = command_header();
  const auto expect_header = [&](auto received, const auto& message) {
    ASSERT_FALSE(from_message(message, received));
    EXPECT_EQ(received.stamp_ns, sent.stamp_ns);
    EXPECT_EQ(received.sequence, sent.sequence);
    EXPECT_EQ(received.imu_sequence, sent.imu_sequence);
    EXPECT_EQ(received.mocap_sequence, sent.mocap_sequence);
    EXPECT_EQ(received.rotor_state, sent.rotor_state);
    EXPECT_EQ(received.term, sent.term);
  };
  expect_header(plant::ActuatorCommand(), example<msg::ActuatorCommand>());
  expect_header(plant::RatesSetpoint(), example<msg::RatesSetpoint>());
  expect_header(plant::AttitudeSetpoint(), example<msg::AttitudeSetpoint>());
  expect_header(plant::TrajectorySetpoint(), example<msg::TrajectorySetpoint>());
}

TEST(Convert, RoundTripPreservesStructs) {
  plant::ActuatorCommand command;
  ASSERT_FALSE(from_message(example<msg::ActuatorCommand>(), command));
  const plant::ActuatorCommand sent = actuator_command();
  EXPECT_EQ(command.rotor_count, sent.rotor_count);
  EXPECT_EQ(command.throttle, sent.throttle);

  plant::PoseSample pose;
  ASSERT_FALSE(from_message(example<msg::MocapPose>(), pose));
  EXPECT_TRUE(pose.tracked);
  EXPECT_EQ(pose.position_ned, pose_sample().position_ned);
  EXPECT_EQ(pose.q_ned_from_frd.coeffs(), pose_sample().q_ned_from_frd.coeffs());
}

// GIVEN a valid message WHEN `change` invalidates it THEN it is refused with these words and the struct is
// unchanged.
template <class Plain, class Message, class Change>
void expect_refused(Message message, const char* words, Change change) {
  change(message);
  Plain plain;
  const Plain untouched = plain;
  const Fault fault = from_message(message, plain);
  EXPECT_STREQ(fault.text, words);
  EXPECT_TRUE(to_message(plain) == to_message(untouched));
}

// The flight state is copied byte by byte between processes, so every field must be included.
TEST(Convert, FlightStateIsTransferredCompletely) {
  ControllerReport report;
  ASSERT_FALSE(from_message(example<msg::ControllerState>(), report));
  const control::SupervisorState& got = report.flight.supervisor;
  const control::SupervisorState sent = controller_report().flight.supervisor;
  EXPECT_EQ(got.mode, sent.mode);
  EXPECT_EQ(got.now_ns, sent.now_ns);
  EXPECT_EQ(got.guidance.mission.item_index, sent.guidance.mission.item_index);
  EXPECT_EQ(got.guidance.path.end_ns, sent.guidance.path.end_ns);
  for (const double since_s : {0.0, 0.7, 1.9}) {
    const std::int64_t stamp_ns = sent.guidance.path.start_ns + static_cast<std::int64_t>(since_s * 1e9);
    constexpr double kSinglePrecision = 1e-6;  // of paths
    EXPECT_TRUE(got.guidance.path.at(stamp_ns).position_ned.isApprox(
        sent.guidance.path.at(stamp_ns).position_ned, kSinglePrecision));
    EXPECT_NEAR(got.guidance.path.at(stamp_ns).yaw_rad, sent.guidance.path.at(stamp_ns).yaw_rad,
                10.0 * kSinglePrecision);
  }
  EXPECT_FALSE(differ_in_state(got.requests, sent.requests));
  for (std::size_t i = 0; i < got.requests.size(); ++i) {
    EXPECT_FLOAT_EQ(static_cast<float>(got.requests[i].progress),
                    static_cast<float>(sent.requests[i].progress));
    EXPECT_EQ(result_of(got.requests[i]), result_of(sent.requests[i]));
  }
  EXPECT_EQ(report.flight.position_integral, controller_report().flight.position_integral);
  EXPECT_EQ(report.flight.lift_ratio, controller_report().flight.lift_ratio);
  EXPECT_EQ(report.flight.throttle, controller_report().flight.throttle);
}

TEST(Convert, RequestStatusHasStateAndReason) {
  const control::RequestStatuses requests = controller_report().flight.supervisor.requests;
  const msg::RequestStatus executing = to_message(requests[1]);
  EXPECT_EQ(executing.client(), 40U);
  EXPECT_EQ(executing.id(), 41U);
  EXPECT_EQ(executing.kind(), msg::Command_Constants::MISSION_START);
  EXPECT_EQ(executing.state(), msg::RequestStatus_Constants::EXECUTING);
  EXPECT_EQ(executing.progress(), 0.4);
  EXPECT_STREQ(executing.result().c_str(), "");
  EXPECT_EQ(to_message(requests[2]).state(), msg::RequestStatus_Constants::CANCELED);
  EXPECT_STREQ(to_message(requests[2]).result().c_str(), "canceled by a newer request: hold");
  EXPECT_EQ(to_message(requests[3]).state(), msg::RequestStatus_Constants::ABORTED);
  EXPECT_STREQ(to_message(requests[3]).result().c_str(), "aborted: tipped over");
}

TEST(Convert, ImuSampleCarriesTheObeyedCommand) {
  for (const plant::ObeyedCommand& obeyed :
       {plant::ObeyedCommand{}, plant::ObeyedCommand{true, false, 0, 0, 5},
        plant::ObeyedCommand{true, true, 7, 8}}) {
    msg::Imu message = example<msg::Imu>();
    message.obeyed(to_message(obeyed));
    const plant::ObeyedCommand got = from_message(message.obeyed());
    EXPECT_EQ(got.reported, obeyed.reported);
    EXPECT_EQ(got.any, obeyed.any);
    EXPECT_EQ(got.term, obeyed.term);
    EXPECT_EQ(got.stamp_ns, obeyed.stamp_ns);
    EXPECT_EQ(got.boot, obeyed.boot);
  }
  EXPECT_FALSE(from_message(msg::Imu().obeyed()).reported) << "a vehicle that does not set the fields";
}

TEST(Convert, RefusesInvalidSamples) {
  expect_refused<plant::ImuSample>(example<msg::Imu>(), "body_rates_frd[1] is nan, must be finite",
                                   [](msg::Imu& m) { m.body_rates_frd()[1] = kNan; });
  expect_refused<plant::ImuSample>(example<msg::Imu>(), "specific_force_frd[2] is -inf, must be finite",
                                   [](msg::Imu& m) { m.specific_force_frd()[2] = -kInfinity; });
  expect_refused<plant::ImuSample>(example<msg::Imu>(), "stamp_ns is -1, must be at least 0",
                                   [](msg::Imu& m) { m.stamp_ns(-1); });
  expect_refused<plant::PoseSample>(example<msg::MocapPose>(), "position_ned[0] is nan, must be finite",
                                    [](msg::MocapPose& m) { m.position_ned()[0] = kNan; });
  expect_refused<plant::PoseSample>(example<msg::MocapPose>(),
                                    "q_ned_from_frd has the length 0, must be 1 within 0.001",
                                    [](msg::MocapPose& m) {
                                      m.q_ned_from_frd({0.0, 0.0, 0.0, 0.0});
                                    });
  expect_refused<plant::BatterySample>(example<msg::Battery>(), "voltage_v is -0.1, must be at least 0",
                                       [](msg::Battery& m) { m.voltage_v(-0.1); });
  expect_refused<plant::BatterySample>(example<msg::Battery>(),
                                       "state_of_charge is nan, must be between 0 and 1",
                                       [](msg::Battery& m) { m.state_of_charge(kNan); });
  expect_refused<plant::RotorSpeedSample>(example<msg::RotorSpeeds>(), "rotor_count is 9, must be at most 8",
                                          [](msg::RotorSpeeds& m) { m.rotor_count(9); });
  expect_refused<plant::TruthSample>(example<msg::GroundTruth>(), "velocity_ned[2] is nan, must be finite",
                                     [](msg::GroundTruth& m) { m.velocity_ned()[2] = kNan; });
}

TEST(Convert, RefusesInvalidCommandsAndStates) {
  expect_refused<plant::ActuatorCommand>(example<msg::ActuatorCommand>(),
                                         "throttle[3] is 1.01, must be between 0 and 1",
                                         [](msg::ActuatorCommand& m) { m.throttle()[3] = 1.01; });
  expect_refused<plant::ActuatorCommand>(example<msg::ActuatorCommand>(),
                                         "throttle[0] is nan, must be between 0 and 1",
                                         [](msg::ActuatorCommand& m) { m.throttle()[0] = kNan; });
  expect_refused<plant::ActuatorCommand>(example<msg::ActuatorCommand>(),
                                         "rotor_state is 2, must be at most 1",
                                         [](msg::ActuatorCommand& m) { m.rotor_state(2); });
  expect_refused<plant::RatesSetpoint>(example<msg::RatesSetpoint>(),
                                       "body_rates_frd[1] is nan, must be finite",
                                       [](msg::RatesSetpoint& m) { m.body_rates_frd()[1] = kNan; });
  expect_refused<plant::RatesSetpoint>(example<msg::RatesSetpoint>(), "thrust_n is -0.1, must be at least 0",
                                       [](msg::RatesSetpoint& m) { m.thrust_n(-0.1); });
  expect_refused<plant::RatesSetpoint>(example<msg::RatesSetpoint>(), "rotor_state is 2, must be at most 1",
                                       [](msg::RatesSetpoint& m) { m.rotor_state(2); });
  expect_refused<plant::AttitudeSetpoint>(example<msg::AttitudeSetpoint>(),
                                          "q_ned_from_frd has the length 1.32288, must be 1 within 0.001",
                                          [](msg::AttitudeSetpoint& m) { m.q_ned_from_frd()[0] = 1.0; });
  expect_refused<plant::AttitudeSetpoint>(example<msg::AttitudeSetpoint>(), "thrust_n is inf, must be finite",
                                          [](msg::AttitudeSetpoint& m) { m.thrust_n(kInfinity); });
  expect_refused<plant::TrajectorySetpoint>(example<msg::TrajectorySetpoint>(),
                                            "position_ned[2] is nan, must be finite",
                                            [](msg::TrajectorySetpoint& m) { m.position_ned()[2] = kNan; });
  expect_refused<plant::TrajectorySetpoint>(example<msg::TrajectorySetpoint>(), "yaw is nan, must be finite",
                                            [](msg::TrajectorySetpoint& m) { m.yaw(kNan); });
  expect_refused<ControllerReport>(example<msg::ControllerState>(), "mode is 10, must be at most 9",
                                   [](msg::ControllerState& m) { m.mode(10); });
  expect_refused<ControllerReport>(example<msg::ControllerState>(), "path_x[3] is nan, must be finite",
                                   [](msg::ControllerState& m) { m.path_x()[3] = kNan; });
  expect_refused<ControllerReport>(example<msg::ControllerState>(), "item_index is 40, must be at most 31",
                                   [](msg::ControllerState& m) { m.item_index(40); });
  expect_refused<ControllerReport>(example<msg::ControllerState>(), "request_states is 7, must be at most 6",
                                   [](msg::ControllerState& m) { m.request_states()[2] = 7; });
  expect_refused<ControllerReport>(example<msg::ControllerState>(),
                                   "request_progress is nan, must be between 0 and 1",
                                   [](msg::ControllerState& m) { m.request_progress()[3] = kNan; });
  expect_refused<control::Setpoint>(example<msg::Setpoint>(), "yaw_rate is inf, must be finite",
                                    [](msg::Setpoint& m) { m.yaw_rate(kInfinity); });
}

TEST(Convert, SetpointKindSelectsTheFieldsThatAreRead) {
  using control::SetpointKind;
  control::Setpoint all = setpoint();
  all.q_ned_from_frd = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  all.body_rates_frd = {0.1, 0.2, 0.3};
  all.specific_thrust = 9.0;
  const auto converted = [&all](SetpointKind kind) {
    all.kind = kind;
    control::Setpoint out;
    EXPECT_STREQ(from_message(to_message(all), out).text, "");
    EXPECT_EQ(out.kind, kind);
    return out;
  };
  const Eigen::Vector3d nothing = Eigen::Vector3d::Zero();
  for (const SetpointKind kind :
       {SetpointKind::kPosition, SetpointKind::kVelocity, SetpointKind::kAcceleration}) {
    const control::Setpoint out = converted(kind);
    EXPECT_EQ(out.position_ned, kind == SetpointKind::kPosition ? all.position_ned : nothing);
    EXPECT_EQ(out.velocity_ned, kind == SetpointKind::kAcceleration ? nothing : all.velocity_ned);
    EXPECT_EQ(out.acceleration_ned, all.acceleration_ned);
    EXPECT_EQ(out.yaw_rad, all.yaw_rad);
    EXPECT_EQ(out.yaw_rate, all.yaw_rate);
    EXPECT_EQ(out.specific_thrust, 0.0);
  }
  const control::Setpoint attitude = converted(SetpointKind::kAttitude);
  EXPECT_EQ(attitude.q_ned_from_frd.coeffs(), all.q_ned_from_frd.coeffs());
  EXPECT_EQ(attitude.body_rates_frd, all.body_rates_frd);
  EXPECT_EQ(attitude.specific_thrust, all.specific_thrust);
  EXPECT_EQ(attitude.acceleration_ned, nothing);
  const control::Setpoint rates = converted(SetpointKind::kBodyRates);
  EXPECT_EQ(rates.q_ned_from_frd.coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(rates.body_rates_frd, all.body_rates_frd);

  all.kind = SetpointKind::kVelocity;
  msg::Setpoint message = to_message(all);
  message.position_ned()[0] = kNan;
  message.specific_thrust(kNan);
  message.q_ned_from_frd({0.0, 0.0, 0.0, 0.0});
  control::Setpoint out;
  EXPECT_STREQ(from_message(message, out).text, "");
  message.yaw_free(true);
  message.yaw(kNan);
  EXPECT_STREQ(from_message(message, out).text, "");
  expect_refused<control::Setpoint>(to_message(all), "kind is 5, must be at most 4",
                                    [](msg::Setpoint& m) { m.kind(5); });
  all.kind = SetpointKind::kAttitude;
  expect_refused<control::Setpoint>(to_message(all), "specific_thrust is nan, must be finite",
                                    [](msg::Setpoint& m) { m.specific_thrust(kNan); });
  expect_refused<control::Setpoint>(
      to_message(all), "q_ned_from_frd has the length 0, must be 1 within 0.001", [](msg::Setpoint& m) {
        m.q_ned_from_frd({0.0, 0.0, 0.0, 0.0});
      });
}

TEST(Convert, RefusesInvalidRequests) {
  expect_refused<control::Request>(example<msg::Command>(), "kind is 13, must be at most 12",
                                   [](msg::Command& m) { m.kind(13); });
  expect_refused<control::Request>(example<msg::Command>(), "position_ned[1] is nan, must be finite",
                                   [](msg::Command& m) { m.position_ned()[1] = kNan; });
  expect_refused<control::Mission>(example<msg::Mission>(), "item 5: speed is nan, must be finite",
                                   [](msg::Mission& m) { m.items()[4].speed(kNan); });
  expect_refused<control::Mission>(example<msg::Mission>(), "item 1: kind is 5, must be at most 4",
                                   [](msg::Mission& m) { m.items()[0].kind(5); });
  expect_refused<control::Mission>(example<msg::Mission>(), "segment 2: x[3] is nan, must be finite",
                                   [](msg::Mission& m) { m.segments()[1].x()[3] = kNan; });
  expect_refused<control::Mission>(example<msg::Mission>(),
                                   "number of segments is 1025, must be at most 1024",
                                   [](msg::Mission& m) { m.segments().resize(1025); });
  expect_refused<control::Mission>(example<msg::Mission>(), "item 2: hold_s is -1, must be at least 0",
                                   [](msg::Mission& m) { m.items()[1].hold_s(-1.0); });
  expect_refused<control::Mission>(example<msg::Mission>(), "number of items is 2049, must be at most 2048",
                                   [](msg::Mission& m) { m.items().resize(2049); });
  expect_refused<control::Trajectory>(example<msg::Trajectory>(), "segment 3: z[7] is nan, must be finite",
                                      [](msg::Trajectory& m) { m.segments()[2].z()[7] = kNan; });
  expect_refused<control::Trajectory>(example<msg::Trajectory>(),
                                      "segment 2: duration_s is -2, must be at least 0",
                                      [](msg::Trajectory& m) { m.segments()[1].duration_s(-2.0); });
}

TEST(Convert, IgnoresThePositionOfAnUntrackedPose) {
  msg::MocapPose message = example<msg::MocapPose>();
  message.tracked(false);
  message.position_ned()[0] = kNan;
  plant::PoseSample pose;
  EXPECT_FALSE(from_message(message, pose));
  EXPECT_FALSE(pose.tracked);
  EXPECT_EQ(pose.position_ned, Eigen::Vector3d::Zero());
}

TEST(Convert, IgnoresAPositionThatIsNotUsed) {
  msg::TrajectorySetpoint message = example<msg::TrajectorySetpoint>();
  message.position_used(false);
  message.position_ned()[0] = kNan;
  plant::TrajectorySetpoint setpoint;
  EXPECT_FALSE(from_message(message, setpoint));
  EXPECT_EQ(setpoint.position_ned, Eigen::Vector3d::Zero());
}

TEST(Convert, IgnoresRotorsBeyondTheCount) {
  msg::ActuatorCommand message = example<msg::ActuatorCommand>();
  message.throttle()[6] = kNan;
  plant::ActuatorCommand command;
  EXPECT_FALSE(from_message(message, command));
  EXPECT_EQ(command.throttle[6], 0.0);
}

}  // namespace swiftlet::messages::fixtures::convert_test
