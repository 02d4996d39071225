// Which part of the system writes each topic, for the permissions of DDS Security. Every part may read every topic.
#pragma once

namespace swiftlet::messages {

// Parts of the system, as identities of DDS Security.
namespace roles {
inline constexpr const char* kVehicle = "vehicle";
inline constexpr const char* kMocap = "mocap";
inline constexpr const char* kControl = "control";
inline constexpr const char* kGround = "ground";      // tools that command
inline constexpr const char* kObserver = "observer";  // tools that only read, and discovery servers
}  // namespace roles
inline constexpr const char* kRoles[] = {roles::kVehicle, roles::kMocap, roles::kControl, roles::kGround,
                                         roles::kObserver};

struct WrittenTopic {
  const char* name;
  const char* role;
};
inline constexpr WrittenTopic kWrittenTopics[] = {
    {"imu", roles::kVehicle},
    {"vehicle_odometry", roles::kVehicle},
    {"rotor_speeds", roles::kVehicle},
    {"battery", roles::kVehicle},
    {"ground_truth", roles::kVehicle},
    {"vehicle_info", roles::kVehicle},
    {"clock_reply", roles::kVehicle},
    {"mocap_pose", roles::kMocap},
    {"clock_request", roles::kMocap},
    {"clock_request", roles::kGround},
    {"clock_status", roles::kMocap},
    {"actuator_command", roles::kControl},
    {"rates_setpoint", roles::kControl},
    {"attitude_setpoint", roles::kControl},
    {"trajectory_setpoint", roles::kControl},
    {"controller_state", roles::kControl},
    {"estimate", roles::kControl},
    {"reference", roles::kControl},
    {"control_status", roles::kControl},
    {"mission_status", roles::kControl},
    {"flown_mission", roles::kControl},
    {"flown_trajectory", roles::kControl},
    {"command_ack", roles::kControl},
    {"simulation_clock", roles::kGround},
    {"setpoint", roles::kGround},
    {"ground_link", roles::kGround},
    {"command", roles::kGround},
    {"mission", roles::kGround},
    {"trajectory", roles::kGround},
    {"control_settings", roles::kGround},
};

}  // namespace swiftlet::messages
