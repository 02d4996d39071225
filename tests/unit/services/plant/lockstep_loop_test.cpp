// The lockstep loop with a controller and motion capture that answer, or stay silent.
#include "swiftlet/services/plant/lockstep_loop.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::services::lockstep_loop_test {

namespace msg = messages::msg;
using namespace std::chrono_literals;
using tests::eventually;
using tests::Inbox;
using Samples = std::vector<msg::Imu>;

constexpr std::int64_t kPeriod_ns = 2'000'000;  // of the IMU
constexpr std::uint64_t kSeed = 3;

class Lockstep : public testing::Test {
 public:
  ~Lockstep() override { stop(); }

 protected:
  static dds::NodeSettings node_settings(const dds::DomainLock& lock, const char* name) {
    dds::NodeSettings settings;
    settings.name = name;
    settings.domain = lock.domain();
    return settings;
  }

  Lockstep() {
    settings_.imu.rate_hz = 500.0;
    truth_ = peer_node_.subscribe<msg::GroundTruth>(messages::topics::kGroundTruth,
                                                    [this](const auto& message) { on_truth(message); });
    imu_ = peer_node_.subscribe<msg::Imu>(messages::topics::kImu, [this](const msg::Imu& message) {
      samples_.put(message);
      if (answers_) answer(message);
    });
  }

  void start(const LockstepSettings& lockstep) {
    vehicle_.emplace(tests::kaylion(), settings_, kSeed, plant::VehicleState(), plant_node_);
    loop_.emplace(*vehicle_, settings_, kSeed, lockstep, 4, plant_node_);
    ASSERT_TRUE(eventually([&] {
      return commands_.matched() == 1 && poses_.matched() == 1 && imu_.matched() == 1 &&
             truth_.matched() == 1 && (!lockstep.paused || clock_.matched() == 1);
    }));
    began_ns_ = runtime::monotonic_ns();
    thread_ = std::thread([this] {
      try {
        loop_->run(stop_);
      } catch (const std::runtime_error& error) {
        failure_.put(error.what());
      }
    });
  }
  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    answers_ = false;
  }

  void answer(const msg::Imu& sample) {
    const std::lock_guard<std::mutex> lock(sending_);
    plant::ActuatorCommand command;
    command.stamp_ns = sample.stamp_ns();
    command.sequence = ++command_sequence_;
    command.imu_sequence = sample.sequence_number();
    command.rotor_count = 4;
    commands_.publish(messages::to_message(command));
  }
  void advance_to(std::int64_t stamp_ns) {
    msg::SimulationClock clock;
    clock.advance_to_ns(stamp_ns);
    clock_.publish(clock);
  }
  // Waits until this sample is the newest and was received `times` times: it is resent while time stands
  // still.
  bool is_resent(std::int64_t stamp_ns, std::size_t times = 4) const {
    return samples_.wait([=](const Samples& samples) {
      std::size_t found = 0;
      for (const msg::Imu& sample : samples) found += sample.stamp_ns() == stamp_ns ? 1 : 0;
      return found >= times && samples.back().stamp_ns() == stamp_ns;
    });
  }
  // Waits until the newest sample has been sent several times.
  bool stands_still() const {
    constexpr std::size_t kTimes = 4;
    return samples_.wait([](const Samples& samples) {
      return samples.size() > kTimes &&
             std::all_of(samples.end() - kTimes, samples.end(), [&](const msg::Imu& sample) {
               return sample.stamp_ns() == samples.back().stamp_ns();
             });
    });
  }
  std::int64_t newest_ns() const { return samples_.items().back().stamp_ns(); }
  std::string failure() const {
    return failure_.wait_for_count(1) ? failure_.items().front() : std::string("no failure");
  }

  plant::SimulationSettings settings_;
  Inbox<msg::Imu> samples_;
  std::atomic<bool> answers_{false};  // answer each sample at once
  std::atomic<bool> mocap_answers_{true};
  std::int64_t began_ns_ = 0;
  dds::DomainLock lock_;
  dds::Node plant_node_{node_settings(lock_, "plant")};
  dds::Node peer_node_{node_settings(lock_, "peer")};
  std::optional<SimulatedVehicle> vehicle_;
  std::optional<LockstepLoop> loop_;

 private:
  // As motion capture does: publishes a pose, or a message without one.
  void on_truth(const msg::GroundTruth& message) {
    if (!mocap_answers_) return;
    plant::TruthSample truth;
    if (messages::from_message(message, truth)) return;
    if (truth.sequence > truth_sequence_) {
      truth_sequence_ = truth.sequence;
      const auto pose = mocap_.update(truth);
      last_pose_ = pose ? messages::to_message(*pose) : msg::MocapPose();
      if (!pose) last_pose_.stamp_ns(truth.stamp_ns);
    }
    poses_.publish(last_pose_);
  }

  plant::Mocap mocap_{settings_.mocap, kSeed};
  std::uint64_t truth_sequence_ = 0;
  msg::MocapPose last_pose_;
  std::uint64_t command_sequence_ = 0;
  std::mutex sending_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  Inbox<std::string> failure_;
  dds::Publisher<msg::SimulationClock> clock_ = peer_node_.publish(messages::topics::kSimulationClock);
  dds::Publisher<msg::ActuatorCommand> commands_ = peer_node_.publish(messages::topics::kActuatorCommand);
  dds::Publisher<msg::MocapPose> poses_ = peer_node_.publish(messages::topics::kMocapPose);
  dds::Subscription truth_;  // last: the callbacks use the members above
  dds::Subscription imu_;
};

LockstepSettings with_long_patience() {
  LockstepSettings settings;
  settings.patience_s = 60.0;
  return settings;
}

TEST_F(Lockstep, TimeWaitsForTheAnswerToTheNewestSample) {
  start(with_long_patience());
  ASSERT_TRUE(is_resent(0)) << "the sample is resent until it is answered";
  const msg::Imu first = samples_.items().front();
  answer(first);
  ASSERT_TRUE(is_resent(kPeriod_ns));
  answer(first);  // a repeated answer
  samples_.clear();
  ASSERT_TRUE(is_resent(kPeriod_ns, 3));
  const msg::Imu second = samples_.items().back();
  EXPECT_EQ(second.sequence_number(), first.sequence_number() + 1);
  answer(second);
  ASSERT_TRUE(is_resent(2 * kPeriod_ns));
}

TEST_F(Lockstep, PublishesEverySample) {
  answers_ = true;
  start(with_long_patience());
  ASSERT_TRUE(samples_.wait([](const Samples& samples) {
    return !samples.empty() && samples.back().stamp_ns() >= 200 * kPeriod_ns;
  }));
  stop();
  std::int64_t newest_ns = 0;
  std::uint64_t frames = 0;
  for (const msg::Imu& sample : samples_.items()) {
    EXPECT_LE(sample.stamp_ns(), newest_ns + kPeriod_ns);
    EXPECT_EQ(sample.stamp_ns(), static_cast<std::int64_t>(sample.sequence_number() - 1) * kPeriod_ns);
    EXPECT_GE(sample.lockstep().mocap_pose(), frames);
    newest_ns = std::max(newest_ns, sample.stamp_ns());
    frames = sample.lockstep().mocap_pose();
  }
  EXPECT_NEAR(static_cast<double>(frames), 1e-9 * static_cast<double>(newest_ns) * settings_.mocap.rate_hz,
              2.0);
}

// The peers may start later than the plant.
TEST_F(Lockstep, WaitsForTheFirstAnswers) {
  mocap_answers_ = false;
  LockstepSettings settings;
  settings.patience_s = 0.02;
  start(settings);
  ASSERT_TRUE(is_resent(0, 20)) << "20 ms apart";
  mocap_answers_ = true;
  samples_.clear();
  ASSERT_TRUE(is_resent(0, 20));
  answer(samples_.items().back());
  EXPECT_TRUE(is_resent(kPeriod_ns, 1));
}

TEST_F(Lockstep, NamesASilentController) {
  LockstepSettings settings;
  settings.patience_s = 0.5;
  start(settings);
  ASSERT_TRUE(is_resent(0));
  answer(samples_.items().back());
  EXPECT_EQ(failure(), "lockstep: control is silent: IMU sample 2 of t = 0.002 s has no answer for 0.5 s");
}

TEST_F(Lockstep, NamesSilentMotionCapture) {
  answers_ = true;
  LockstepSettings settings;
  settings.patience_s = 0.5;
  start(settings);
  ASSERT_TRUE(samples_.wait_for_count(10));
  mocap_answers_ = false;
  EXPECT_EQ(failure().rfind("lockstep: mocap is silent: ", 0), 0U) << failure();
  EXPECT_TRUE(is_resent(samples_.items().back().stamp_ns())) << "time must not advance";
}

LockstepSettings going_on() {
  LockstepSettings settings;
  settings.patience_s = 0.2;
  settings.goes_on = true;
  return settings;
}

// GIVEN a vehicle that goes on without a silent controller THEN it does so before the first answer, waits for each once there is
// one, and goes on without it at a quarter of the pace of real time when it falls silent, until it answers again.
TEST_F(Lockstep, GoesOnWithoutASilentController) {
  const auto reaches = [this](std::int64_t stamp_ns) {
    return samples_.wait(
        [=](const Samples& samples) { return !samples.empty() && samples.back().stamp_ns() >= stamp_ns; });
  };
  start(going_on());
  ASSERT_TRUE(reaches(20 * kPeriod_ns)) << "before the first answer";
  for (int time = 0; time < 2; ++time) {
    answers_ = true;
    ASSERT_TRUE(reaches(newest_ns() + 50 * kPeriod_ns));
    answers_ = false;
    ASSERT_TRUE(stands_still()) << "it waits for the answer";
    ASSERT_TRUE(reaches(newest_ns() + 2 * kPeriod_ns)) << "not for ever";
    const std::int64_t begin_ns = runtime::monotonic_ns();
    const std::int64_t from_ns = newest_ns();
    ASSERT_TRUE(reaches(from_ns + 50 * kPeriod_ns));
    const std::int64_t passed_ns = newest_ns() - from_ns;
    EXPECT_LE(passed_ns, (runtime::monotonic_ns() - begin_ns) / 4 + 2 * kPeriod_ns)
        << "a quarter of real time";
  }
}

// Control needs no frame then that does not come.
TEST_F(Lockstep, GoesOnWithoutSilentMotionCapture) {
  answers_ = true;
  start(going_on());
  ASSERT_TRUE(samples_.wait(
      [](const Samples& samples) { return !samples.empty() && samples.back().lockstep().mocap_pose() > 5; }));
  mocap_answers_ = false;
  ASSERT_TRUE(stands_still());
  const std::int64_t stood_ns = newest_ns();
  ASSERT_TRUE(samples_.wait(
      [=](const Samples& samples) { return samples.back().stamp_ns() > stood_ns + 100 * kPeriod_ns; }));
  std::uint64_t frames = 0;
  for (const msg::Imu& sample : samples_.items()) {
    if (sample.stamp_ns() <= stood_ns + kPeriod_ns) continue;
    if (frames == 0) frames = sample.lockstep().mocap_pose();
    EXPECT_EQ(sample.lockstep().mocap_pose(), frames);
  }
}

// Time advances up to the simulation clock; an earlier clock message has no effect.
TEST_F(Lockstep, PausedTimeAdvancesWithTheSimulationClock) {
  answers_ = true;
  LockstepSettings settings = with_long_patience();
  settings.paused = true;
  start(settings);
  advance_to(0);
  ASSERT_TRUE(is_resent(0));
  advance_to(3 * kPeriod_ns + kPeriod_ns / 2);
  ASSERT_TRUE(is_resent(3 * kPeriod_ns));
  advance_to(kPeriod_ns);
  samples_.clear();
  ASSERT_TRUE(is_resent(3 * kPeriod_ns));
  advance_to(10 * kPeriod_ns);
  ASSERT_TRUE(is_resent(10 * kPeriod_ns));
}

// An earlier clock message must not reduce the time allowed by the one before; here no answer lets time
// advance.
TEST_F(Lockstep, EarlierClockMessageHasNoEffect) {
  LockstepSettings settings = with_long_patience();
  settings.paused = true;
  start(settings);
  advance_to(0);
  ASSERT_TRUE(is_resent(0));
  advance_to(4 * kPeriod_ns);
  advance_to(kPeriod_ns);
  ASSERT_TRUE(is_resent(0, 8));
  answers_ = true;
  EXPECT_TRUE(is_resent(4 * kPeriod_ns));
}

TEST_F(Lockstep, NamesASilentGround) {
  answers_ = true;
  LockstepSettings settings;
  settings.paused = true;
  settings.patience_s = 1.0;  // also for answers on a loaded machine
  start(settings);
  advance_to(5 * kPeriod_ns);
  EXPECT_EQ(failure(), "lockstep: ground is silent: no simulation_clock has come for 1 s");
}

// However fast the answers arrive, simulated time runs at half the speed of the clock at most.
TEST_F(Lockstep, DoesNotExceedItsSpeed) {
  answers_ = true;
  LockstepSettings settings = with_long_patience();
  settings.speed = 0.5;
  start(settings);
  std::int64_t newest_ns = 0;
  ASSERT_TRUE(eventually([&] {
    if (samples_.size() > 0) newest_ns = samples_.items().back().stamp_ns();
    const std::int64_t passed_ns = runtime::monotonic_ns() - began_ns_;
    EXPECT_LE(newest_ns, passed_ns / 2 + kPeriod_ns);
    return newest_ns > 200'000'000;
  }));
}

TEST_F(Lockstep, RefusesATraceThatCannotBeWritten) {
  LockstepSettings settings = with_long_patience();
  settings.trace = "/proc/none/trace.csv";
  vehicle_.emplace(tests::kaylion(), settings_, kSeed, plant::VehicleState(), plant_node_);
  EXPECT_THROW(LockstepLoop(*vehicle_, settings_, kSeed, settings, 4, plant_node_), std::runtime_error);
}

}  // namespace swiftlet::services::lockstep_loop_test
