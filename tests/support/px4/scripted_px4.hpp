// A scripted PX4 on DDS: px4_simulation.hpp in real time. It publishes and obeys PX4's topics as PX4 1.16 does through its agent:
// best effort, at 100 Hz, with stamps in us that lag. The ground truth of the vehicle goes to motion capture.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/px4/px4_topics.hpp"
#include "tests/support/px4/px4_simulation.hpp"

namespace swiftlet::tests {

struct ScriptedPx4Settings {
  int instance = 0;
  double east_m = 0.0;  // where it stands
  std::string status_topic = "/out/vehicle_status_v1";
  std::int64_t stamps_lag_us = 40'000;  // of the stamps that go out, after the clock of the agent
};

class ScriptedPx4 {
 public:
  // network.vehicle: whose ground truth is published.
  ScriptedPx4(const plant::Vehicle& vehicle, const dds::NodeSettings& network,
              const ScriptedPx4Settings& settings = {});
  ~ScriptedPx4();
  ScriptedPx4(const ScriptedPx4&) = delete;
  ScriptedPx4& operator=(const ScriptedPx4&) = delete;

  // Calls the function with the simulation, while nothing else uses it, and returns what it returns.
  template <class Function>
  auto with(Function function) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return function(simulation_);
  }
  void pilot_selects(std::uint8_t nav_state);

  px4_msg::VehicleStatus status() const {
    return with([](const Px4Simulation& px4) { return px4.status(); });
  }
  bool armed() const { return status().arming_state() == 2; }
  double height_m() const {
    return with([](const Px4Simulation& px4) { return px4.height_m(); });
  }
  std::uint64_t offboard_modes() const {
    return with([](const Px4Simulation& px4) { return px4.offboard_modes(); });
  }

 private:
  template <class Message>
  void subscribe(const px4::Px4Topic<Message>& topic, void (Px4Simulation::*take)(const Message&));
  void run();
  void publish(Px4Messages messages, plant::TruthSample truth);
  std::uint64_t stamp_us() const;

  const ScriptedPx4Settings settings_;
  const px4::Px4Topics topics_;
  const px4::Px4Topic<px4_msg::VehicleStatus> status_topic_;

  mutable std::mutex mutex_;  // guards the simulation
  Px4Simulation simulation_;
  std::uint64_t truths_ = 0;

  dds::Node node_;
  dds::Publisher<px4_msg::SensorCombined> sensors_;
  dds::Publisher<px4_msg::VehicleOdometry> odometry_;
  dds::Publisher<px4_msg::BatteryStatus> battery_;
  dds::Publisher<px4_msg::VehicleStatus> status_;
  dds::Publisher<px4_msg::VehicleLandDetected> land_detected_;
  dds::Publisher<px4_msg::FailsafeFlags> flags_;
  dds::Publisher<px4_msg::VehicleCommandAck> acks_;
  dds::Publisher<messages::msg::GroundTruth> truth_;
  std::vector<dds::Subscription> subscriptions_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace swiftlet::tests
