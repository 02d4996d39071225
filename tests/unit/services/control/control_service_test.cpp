// The control service on its own DDS domain: scheduling of its threads, and how it reports it.
#include "swiftlet/services/control/control_service.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <sched.h>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/private_domain.hpp"

namespace swiftlet::services::control_service_test {

namespace msg = messages::msg;
namespace topics = messages::topics;
using swiftlet::tests::eventually;

std::vector<pid_t> realtime_threads() {
  std::vector<pid_t> threads;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    const pid_t thread = std::stoi(task.path().filename());
    if (::sched_getscheduler(thread) == SCHED_FIFO) threads.push_back(thread);
  }
  return threads;
}

bool may_be_realtime() {
  bool granted = false;
  std::thread([&] {
    runtime::RealtimeSettings settings;
    settings.priority = 10;
    granted = runtime::make_this_thread_realtime(settings).empty();
  }).join();
  return granted;
}

// A service for which the test plays motion capture and a vehicle at rest.
class RealtimeService : public testing::Test {
 public:
  ~RealtimeService() override {
    stop_ = true;
    service_->wake();
    telemetry_.join();
  }

 protected:
  RealtimeService() {
    runtime::RealtimeSettings realtime;
    realtime.priority = 10;
    service_ = std::make_unique<ControlService>(
        io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
        io::load_control_settings(tests::in_source("config/control/motor_lag.yaml")), 0, control_node_,
        realtime, runtime::Clock::kRealtime);
    telemetry_ = std::thread([this] { service_->run(stop_); });
  }

  void send_samples() {
    ++sequence_;
    msg::Imu imu;
    imu.stamp_ns(static_cast<std::int64_t>(sequence_) * 2'000'000);
    imu.sequence_number(sequence_);
    imu.specific_force_frd({0.0, 0.0, -9.81});
    imu.obeyed(messages::to_message(plant::ObeyedCommand{true, false, 0, 0}));
    imu_.publish(imu);
    last_imu_ = imu;
    msg::MocapPose pose;
    pose.stamp_ns(imu.stamp_ns());
    pose.sequence_number(sequence_);
    pose.tracked(true);
    pose.q_ned_from_frd({1.0, 0.0, 0.0, 0.0});
    pose_.publish(pose);
  }
  // While samples arrive: waits for this number of SCHED_FIFO threads and for a status that reports
  // `reported`.
  bool becomes(std::size_t threads, bool reported) {
    return eventually([&] {
      send_samples();
      return realtime_threads().size() == threads && reported_ == static_cast<int>(reported);
    });
  }
  void forget_reported() { reported_ = -1; }

  dds::DomainLock lock_;
  dds::Node vehicle_node_{tests::settings_of("plant", lock_)};
  dds::Node control_node_{tests::settings_of("control", lock_)};
  std::atomic<int> reported_{-1};
  dds::Subscription status_ = vehicle_node_.subscribe<msg::ControlStatus>(
      topics::kControlStatus, [this](const msg::ControlStatus& status) {
        reported_ = static_cast<int>(status.realtime_scheduling());
      });
  dds::Publisher<msg::Imu> imu_ = vehicle_node_.publish(topics::kImu);
  dds::Publisher<msg::MocapPose> pose_ = vehicle_node_.publish(topics::kMocapPose);
  std::uint64_t sequence_ = 0;
  msg::Imu last_imu_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<ControlService> service_;
  std::thread telemetry_;
};

TEST_F(RealtimeService, ThreadsAreRealtimeAgainAfterARejoin) {
  if (!may_be_realtime()) GTEST_SKIP() << "SCHED_FIFO is not permitted here";
  ASSERT_TRUE(becomes(2, true)) << "threads of the IMU and of poses";
  const std::vector<pid_t> before = realtime_threads();

  control_node_.rejoin();
  EXPECT_EQ(realtime_threads().size(), 0U) << "the threads have ended";
  forget_reported();

  EXPECT_TRUE(becomes(2, true));
  EXPECT_NE(realtime_threads(), before);
}

TEST_F(RealtimeService, StatusReflectsTheCurrentScheduling) {
  if (!may_be_realtime()) GTEST_SKIP() << "SCHED_FIFO is not permitted here";
  ASSERT_TRUE(becomes(2, true));
  const sched_param none{};
  ASSERT_EQ(::sched_setscheduler(realtime_threads().back(), SCHED_OTHER, &none), 0);
  EXPECT_TRUE(becomes(1, false));
}

// A plant in lockstep repeats a sample while its time stands still: the command for it may be lost.
TEST_F(RealtimeService, ARepeatedSampleIsAnsweredWithTheSameCommand) {
  tests::Inbox<msg::ActuatorCommand> commands;
  const auto subscription = vehicle_node_.subscribe<msg::ActuatorCommand>(
      topics::kActuatorCommand, [&](const msg::ActuatorCommand& command) { commands.put(command); });
  ASSERT_TRUE(eventually([&] {
    send_samples();
    return commands.size() > 0;
  }));
  ASSERT_TRUE(commands.wait([&](const auto& all) { return all.back().imu_sequence_number() == sequence_; }));
  const std::size_t before = commands.size();
  ASSERT_TRUE(eventually([&] {
    imu_.publish(last_imu_);
    return commands.size() > before + 3;
  }));
  const auto all = commands.items();
  for (std::size_t i = before; i < all.size(); ++i) EXPECT_TRUE(all[i] == all[before - 1]) << i;
}

// GIVEN a vehicle whose messages have another version WHEN it is to be armed THEN that is refused by a sentence that says so.
TEST_F(RealtimeService, AVehicleOfAnotherWireVersionIsNotArmed) {
  tests::Inbox<msg::CommandAck> answers;
  const auto acks = vehicle_node_.subscribe<msg::CommandAck>(
      topics::kCommandAck, [&](const msg::CommandAck& answer) { answers.put(answer); });
  auto infos = vehicle_node_.publish(topics::kVehicleInfo);
  auto commands = vehicle_node_.publish(topics::kCommand);
  msg::VehicleInfo info;
  info.wire_version(messages::kWireVersion + 1);
  infos.publish(info);
  ASSERT_TRUE(eventually([&] { return commands.matched() == 1 && infos.matched() == 1; }));
  ASSERT_TRUE(infos.wait_until_received(std::chrono::seconds(10)));
  msg::Command arm;
  arm.client(1);
  arm.kind(msg::Command_Constants::ARM);
  ASSERT_TRUE(eventually([&] {
    send_samples();
    arm.id(arm.id() + 1);
    commands.publish(arm);
    return std::any_of(answers.items().begin(), answers.items().end(), [](const msg::CommandAck& answer) {
      return std::string(answer.reason().c_str())
                 .find(messages::fault_of_wire_version(messages::kWireVersion + 1, "the vehicle")) !=
             std::string::npos;
    });
  }));
  for (const msg::CommandAck& answer : answers.items()) EXPECT_FALSE(answer.accepted());

  info.wire_version(messages::kWireVersion);
  infos.publish(info);
  EXPECT_TRUE(eventually([&] {
    send_samples();
    arm.id(arm.id() + 1);
    commands.publish(arm);
    return answers.size() > 0 &&
           std::string(answers.items().back().reason().c_str()).find("speaks") == std::string::npos;
  })) << "of its successor";
}

}  // namespace swiftlet::services::control_service_test
