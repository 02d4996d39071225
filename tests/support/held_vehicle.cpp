#include "tests/support/held_vehicle.hpp"

#include <chrono>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::tests {
namespace {

constexpr std::uint64_t kSeed = 3;
constexpr std::int64_t kPeriod_ns = 2'000'000;
constexpr std::int64_t kBattery_ns = 100'000'000;
constexpr std::int64_t kInfo_ns = 1'000'000'000;
constexpr std::int64_t kFirst_ns = 1'000'000'000;
constexpr std::int64_t kTimesRealTime = 4;

}  // namespace

HeldVehicle::HeldVehicle(const dds::NodeSettings& network)
    : path_({{0.3, 0.1, -0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()))}),
      imu_({}, kSeed),
      mocap_({}, kSeed),
      node_(network),
      imu_publisher_(node_.publish(messages::topics::kImu)),
      mocap_publisher_(node_.publish(messages::topics::kMocapPose)),
      battery_publisher_(node_.publish(messages::topics::kBattery)),
      info_publisher_(node_.publish(messages::topics::kVehicleInfo)),
      thread_([this] { run(); }) {}

HeldVehicle::~HeldVehicle() {
  stop_ = true;
  thread_.join();
}

void HeldVehicle::move(ground::HandStep step) {
  const std::lock_guard lock(mutex_);
  path_.move(step, time_s_);
}

void HeldVehicle::run() {
  const auto begin = std::chrono::steady_clock::now();
  for (std::int64_t tick_ns = 0; !stop_; tick_ns += kPeriod_ns) {
    publish(kFirst_ns + tick_ns);
    std::this_thread::sleep_until(begin + std::chrono::nanoseconds((tick_ns + kPeriod_ns) / kTimesRealTime));
  }
}

void HeldVehicle::publish(std::int64_t stamp_ns) {
  const std::lock_guard lock(mutex_);
  time_s_ = 1e-9 * static_cast<double>(stamp_ns);
  const plant::ImuSample sample =
      imu_.sample(stamp_ns, path_.specific_force_frd(time_s_), path_.body_rates_frd(time_s_));
  imu_publisher_.publish(messages::to_message(sample));
  const HandPose pose = path_.at(time_s_);
  if (const auto frame = mocap_.update(stamp_ns, pose.position_ned, pose.q_ned_from_frd))
    mocap_publisher_.publish(messages::to_message(*frame));
  if (stamp_ns % kBattery_ns == 0)
    battery_publisher_.publish(
        messages::to_message(plant::BatterySample{stamp_ns, ++batteries_, 4.1, 0.1, 0.9}));
  if (stamp_ns % kInfo_ns != 0) return;
  messages::msg::VehicleInfo info;
  info.wire_version(messages::kWireVersion);
  info.stamp_ns(stamp_ns);
  info.name("held");
  info.rotor_count(4);
  info.simulated(true);
  info.imu_rate_hz(1e9 / static_cast<double>(kPeriod_ns));
  info_publisher_.publish(info);
}

}  // namespace swiftlet::tests
