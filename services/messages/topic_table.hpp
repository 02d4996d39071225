// The topics of a vehicle, as in idl/README.md. The wire name is rt/<vehicle>/<name>.
#pragma once

// TOPIC(type, name, QoS profile of qos.hpp, roles of topic_roles.hpp that write it), or TOPIC_OF(type, constant, ...) for a further topic
// of a type.
// clang-format off
#define SWIFTLET_TOPICS(TOPIC, TOPIC_OF) \
  TOPIC(Imu, "imu", Stream, roles::kVehicle)                                               \
  TOPIC(VehicleOdometry, "vehicle_odometry", Stream, roles::kVehicle)                      \
  TOPIC(ActuatorCommand, "actuator_command", Stream, roles::kControl)                      \
  TOPIC(RatesSetpoint, "rates_setpoint", Stream, roles::kControl)                          \
  TOPIC(AttitudeSetpoint, "attitude_setpoint", Stream, roles::kControl)                    \
  TOPIC(TrajectorySetpoint, "trajectory_setpoint", Stream, roles::kControl)                \
  TOPIC(ControllerState, "controller_state", Stream, roles::kControl)                      \
  TOPIC(MocapPose, "mocap_pose", Stream, roles::kMocap)                                    \
  TOPIC(RotorSpeeds, "rotor_speeds", Stream, roles::kVehicle)                              \
  TOPIC(Setpoint, "setpoint", Stream, roles::kGround)                                      \
  TOPIC(ClockRequest, "clock_request", Stream, roles::kMocap, roles::kGround)              \
  TOPIC(ClockReply, "clock_reply", Stream, roles::kVehicle)                                \
  TOPIC(Battery, "battery", Telemetry, roles::kVehicle)                                    \
  TOPIC(Estimate, "estimate", Telemetry, roles::kControl)                                  \
  TOPIC(Reference, "reference", Telemetry, roles::kControl)                                \
  TOPIC(GroundTruth, "ground_truth", Telemetry, roles::kVehicle)                           \
  TOPIC(ClockStatus, "clock_status", Telemetry, roles::kMocap)                             \
  TOPIC(ControlStatus, "control_status", Latched, roles::kControl)                         \
  TOPIC(MissionStatus, "mission_status", Latched, roles::kControl)                         \
  TOPIC(VehicleInfo, "vehicle_info", Latched, roles::kVehicle)                             \
  TOPIC(GroundLink, "ground_link", Telemetry, roles::kGround)                              \
  TOPIC(SimulationClock, "simulation_clock", Latched, roles::kGround)                      \
  TOPIC(Command, "command", Request, roles::kGround)                                       \
  TOPIC(Mission, "mission", Request, roles::kGround)                                       \
  TOPIC(Trajectory, "trajectory", Request, roles::kGround)                                 \
  TOPIC(ControlSettings, "control_settings", Request, roles::kGround)                      \
  TOPIC_OF(Mission, FlownMission, "flown_mission", LatchedLarge, roles::kControl)          \
  TOPIC_OF(Trajectory, FlownTrajectory, "flown_trajectory", LatchedLarge, roles::kControl) \
  TOPIC(FlownFiles, "flown_files", LatchedLarge, roles::kControl)                          \
  TOPIC(CommandAck, "command_ack", Reply, roles::kControl)
// clang-format on
