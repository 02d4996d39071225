// A vehicle in a hand that does what it is asked for: sensors and motion capture of the simulation on a path, over the
// network, faster than the clock. Its rotors do not exist.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "swiftlet/plant/simulation/imu.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/hand_path.hpp"

namespace swiftlet::tests {

class HeldVehicle {
 public:
  explicit HeldVehicle(const dds::NodeSettings& network);
  ~HeldVehicle();
  HeldVehicle(const HeldVehicle&) = delete;
  HeldVehicle& operator=(const HeldVehicle&) = delete;

  void move(ground::HandStep step);

 private:
  void run();
  void publish(std::int64_t stamp_ns);

  std::mutex mutex_;  // guards path_ and time_s_
  HandPath path_;
  double time_s_ = 0.0;
  plant::Imu imu_;
  plant::Mocap mocap_;
  std::uint64_t batteries_ = 0;

  dds::Node node_;
  dds::Publisher<messages::msg::Imu> imu_publisher_;
  dds::Publisher<messages::msg::MocapPose> mocap_publisher_;
  dds::Publisher<messages::msg::Battery> battery_publisher_;
  dds::Publisher<messages::msg::VehicleInfo> info_publisher_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests
