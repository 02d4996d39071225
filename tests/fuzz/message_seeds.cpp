// Writes seeds for the message fuzzer into a folder: one message of each type, and requests at and beyond
// their size limits, empty and not finite.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "swiftlet/services/dds/message_types.hpp"
#include "tests/fuzz/message_types.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace {

using namespace swiftlet;
using namespace swiftlet::messages::fixtures;
using messages::to_message;
namespace msg = messages::msg;

template <class Type>
void write(const std::filesystem::path& folder, const char* name,
           const typename Type::PubSub::type& message) {
  const auto bytes = swiftlet::tests::serialized<typename Type::PubSub>(message);
  std::ofstream file(folder / name, std::ios::binary);
  file.put(Type::kTag);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

// Writes a message of a type that no process converts, and so none fuzzes. It serves the comparison of what goes over the
// wire.
template <class PubSub>
void write_sent(const std::filesystem::path& folder, const char* name) {
  const auto bytes = swiftlet::tests::serialized<PubSub>(example<typename PubSub::type>());
  std::ofstream file(folder / name, std::ios::binary);
  file.put('\0');
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace swiftlet::tests;
  if (argc != 2) {
    std::fprintf(stderr, "usage: message_seeds FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  write<Imu>(folder, "imu", to_message(imu_sample()));
  write<VehicleOdometry>(folder, "vehicle_odometry", to_message(odometry_sample()));
  write<MocapPose>(folder, "mocap_pose", to_message(pose_sample()));
  write<Battery>(folder, "battery", to_message(battery_sample()));
  write<RotorSpeeds>(folder, "rotor_speeds", to_message(rotor_speed_sample()));
  write<ActuatorCommand>(folder, "actuator_command", to_message(actuator_command()));
  write<RatesSetpoint>(folder, "rates_setpoint", to_message(rates_setpoint()));
  write<AttitudeSetpoint>(folder, "attitude_setpoint", to_message(attitude_setpoint()));
  write<TrajectorySetpoint>(folder, "trajectory_setpoint", to_message(trajectory_setpoint()));
  write<GroundTruth>(folder, "ground_truth", to_message(truth_sample()));
  write<Setpoint>(folder, "setpoint", to_message(setpoint()));
  write<ControllerState>(folder, "controller_state", to_message(controller_report()));
  write<Command>(folder, "command", to_message(request()));
  write<ControlSettings>(folder, "control_settings", to_message(settings_request()));
  msg::GroundLink link;
  link.client(4);
  link.depends(true);
  write<GroundLink>(folder, "ground_link", link);

  write_sent<msg::ClockRequestPubSubType>(folder, "clock_request");
  write_sent<msg::ClockReplyPubSubType>(folder, "clock_reply");
  write_sent<msg::ClockStatusPubSubType>(folder, "clock_status");
  write_sent<msg::CommandAckPubSubType>(folder, "command_ack");
  write_sent<msg::ControlStatusPubSubType>(folder, "control_status");
  write_sent<msg::EstimatePubSubType>(folder, "estimate");
  write_sent<msg::MissionStatusPubSubType>(folder, "mission_status");
  write_sent<msg::ReferencePubSubType>(folder, "reference");
  write_sent<msg::VehicleInfoPubSubType>(folder, "vehicle_info");

  write<Mission>(folder, "mission", to_message(messages::fixtures::mission(5)));
  write<Mission>(folder, "mission_empty", msg::Mission());
  msg::Mission long_mission = to_message(messages::fixtures::mission(control::kMaxMissionItems, 0));
  write<Mission>(folder, "mission_at_its_bound", long_mission);
  long_mission.items().push_back(long_mission.items().front());
  write<Mission>(folder, "mission_past_its_bound", long_mission);
  msg::Mission wrong = to_message(messages::fixtures::mission(2));
  wrong.items().front().speed(std::nan(""));
  write<Mission>(folder, "mission_nan", wrong);

  write<Trajectory>(folder, "trajectory", to_message(messages::fixtures::trajectory(3)));
  write<Trajectory>(folder, "trajectory_empty", msg::Trajectory());
  msg::Trajectory long_trajectory =
      to_message(messages::fixtures::trajectory(control::kMaxTrajectorySegments));
  write<Trajectory>(folder, "trajectory_at_its_bound", long_trajectory);
  long_trajectory.segments().push_back(long_trajectory.segments().front());
  write<Trajectory>(folder, "trajectory_past_its_bound", long_trajectory);
  msg::Trajectory endless = to_message(messages::fixtures::trajectory(1));
  endless.segments().front().duration_s(std::numeric_limits<double>::infinity());
  write<Trajectory>(folder, "trajectory_infinite", endless);
  return 0;
}
