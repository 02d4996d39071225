// Joins a vehicle to ROS 2: what it says as standard types, and goals and velocities of others as requests.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/ros/requests.hpp"
#include "swiftlet/ground/ros/ros_messages.hpp"
#include "swiftlet/record/file/standard_messages.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/throttled_warning.hpp"

namespace swiftlet::ros {

// The time in the headers of the messages.
enum class Time {
  kWall,     // the system clock, when they arrived
  kVehicle,  // their stamps, which `clock` publishes as /clock: for simulated time (use_sim_time)
};

struct GatewaySettings {
  Time time = Time::kWall;
  double goal_speed_m_s = 0.5;  // peak, of flights to goals
};

// Publishes the messages of StandardMessages (standard_messages.hpp) of one vehicle, and obeys
//   goal_pose  geometry_msgs/PoseStamped  flies there and holds; a newer goal replaces it
//   cmd_vel    geometry_msgs/Twist        a stream of velocities, at 2 Hz or more
// The vehicle must have taken off; it refuses both otherwise. What is refused or cannot be sent is logged, of
// streams once a second.
class Gateway {
 public:
  // clock: publishes a time stamp as /clock; may be empty. Throws std::runtime_error.
  Gateway(const ground::Context& context, const std::string& vehicle, const GatewaySettings& settings,
          std::function<void(std::int64_t)> clock);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

 private:
  template <class T>
  void forward(const messages::Topic<T>& topic);
  void take_goal(const Bytes& payload);
  void take_velocity(const Bytes& payload);
  void fly_to_goals();
  double yaw_rad() const;

  const GatewaySettings settings_;
  const std::function<void(std::int64_t)> clock_;
  ground::Vehicle vehicle_;
  record::StandardMessages standard_;                         // of the thread that receives
  std::map<std::string, Writer> writers_;                     // by topic
  dds::ThrottledWarning write_faults_{"what goes to ROS 2"};  // of the same thread
  dds::ThrottledWarning velocity_faults_{"cmd_vel"};  // these two of the thread that receives velocities
  ground::SetpointTally setpoints_;                   // that control has answered

  std::mutex mutex_;  // guards the two below
  std::condition_variable changed_;
  std::optional<Goal> goal_;  // not yet asked for
  bool ending_ = false;

  dds::Node node_;
  std::vector<dds::Subscription> subscriptions_;
  std::unique_ptr<Reader<PoseStamped>> goals_;
  std::unique_ptr<Reader<Twist>> velocities_;
  std::thread pilot_;
};

}  // namespace swiftlet::ros
