#include "swiftlet/ground/cli/check/test_commands.hpp"

#include <algorithm>
#include <chrono>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kTakeoverShift = 16;  // a term counts the takeovers in its upper 16 bits
constexpr std::uint32_t kMostTakeovers = 0xFFFF;
constexpr std::uint64_t kLastCommands = 50;
constexpr auto kLastTime = 500ms;
constexpr auto kLastPeriod = 10ms;  // without IMU samples

dds::NodeSettings commanding(dds::NodeSettings settings) {
  settings.name = "check";
  return settings;
}

}  // namespace

TestCommands::TestCommands(const dds::NodeSettings& settings, int rotor_count, std::uint32_t term)
    : term_(term),
      rotor_count_(rotor_count),
      renewed_ns_(runtime::monotonic_ns()),
      node_(commanding(settings)),
      publisher_(node_.publish(messages::topics::kActuatorCommand)),
      imu_(node_.subscribe<messages::msg::Imu>(
          messages::topics::kImu, [this](const messages::msg::Imu& imu) { answer(imu); },
          dds::Delivery::kSamples, dds::OneSource{dds::kSourceSilence})) {}

TestCommands::~TestCommands() {
  set({});
  const auto is_enough = [this] { return commands_in_order_ >= kLastCommands; };
  const auto end = std::chrono::steady_clock::now() + kLastTime;
  std::unique_lock lock(mutex_);
  while (!is_enough() && std::chrono::steady_clock::now() < end) {
    const std::uint64_t before = commands_in_order_;
    sent_.wait_for(lock, kLastPeriod, is_enough);
    if (commands_in_order_ == before) send();
  }
}

void TestCommands::set(const Order& order) {
  const std::lock_guard lock(mutex_);
  order_ = order;
  commands_in_order_ = 0;
  renewed_ns_ = runtime::monotonic_ns();
}

void TestCommands::renew() {
  const std::lock_guard lock(mutex_);
  renewed_ns_ = runtime::monotonic_ns();
}

// Runs in the subscription's thread.
void TestCommands::answer(const messages::msg::Imu& imu) {
  const std::lock_guard lock(mutex_);
  newest_ = Sample{imu.stamp_ns(), imu.sequence_number()};
  if (runtime::monotonic_ns() - renewed_ns_ > kPatience_ns) order_ = {};
  if (!order_.silent) send();
}

void TestCommands::send() {
  if (!newest_) return;
  plant::ActuatorCommand command;
  command.stamp_ns = newest_->stamp_ns;
  command.sequence = ++commands_;
  command.imu_sequence = newest_->sequence;
  command.rotor_state = order_.state;
  command.rotor_count = rotor_count_;
  command.throttle = order_.throttle;
  command.term = order_.lower_term ? lower_term() : term_;
  publisher_.publish(messages::to_message(command));
  ++commands_in_order_;
  sent_.notify_all();
}

std::uint32_t term_above(std::uint32_t obeyed_term) {
  return std::min((obeyed_term >> kTakeoverShift) + 1, kMostTakeovers) << kTakeoverShift;
}

}  // namespace swiftlet::ground
