#include <algorithm>
#include <chrono>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "swiftlet/ground/cli/check/steps.hpp"
#include "swiftlet/ground/cli/check/test_commands.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kPoll = 5ms;
constexpr auto kOffTime = 700ms;
constexpr auto kIdleTime = 1200ms;
constexpr auto kSpinTime = 1000ms;
constexpr auto kLowerTermTime = 70ms;  // shorter than the shortest command time-out, 100 ms
constexpr auto kSilenceTime = 1800ms;  // longer than one may be
constexpr auto kStopTime = 1500ms;
constexpr double kSpinThrottle = 0.15;
constexpr double kTetherThrust = 0.5;  // of hover
constexpr double kTetherRaise = 0.15;  // of hover, of one rotor
constexpr auto kTetherTime = 800ms;
constexpr auto kRaiseTime = 150ms;
constexpr std::int64_t kRecentCommand_ns = 100'000'000;  // vehicle's clock
constexpr std::chrono::duration<double> kImuSilence = 500ms;
constexpr auto kOwnStall = 100ms;  // this process stood still: samples may wait to be read

// Commands, and notes what was commanded when. All times are seconds of the vehicle.
class CommandSequence {
 public:
  CommandSequence(const SampleRecorder& recorder, const dds::NodeSettings& network,
                  const plant::Vehicle& vehicle, const OperatorDialog& dialog)
      : recorder_(recorder),
        dialog_(dialog),
        rotor_count_(vehicle.rotor_count()),
        commands_(network, rotor_count_, term_above(obeyed_term(recorder))) {}

  void off(CommandStage stage, std::chrono::milliseconds time) { hold(stage, {}, time); }
  void run(double throttle, std::chrono::milliseconds time) {
    hold(CommandStage::kIdle, running(throttle), time);
  }
  CommandPhase& raise(int rotor, double throttle, double of_others, std::chrono::milliseconds time) {
    TestCommands::Order order = running(of_others);
    order.throttle[static_cast<std::size_t>(rotor - 1)] = throttle;
    CommandPhase& phase = hold(CommandStage::kSpin, order, time);
    phase.rotor = rotor;
    return phase;
  }
  void lower_term() {
    TestCommands::Order order;
    order.lower_term = true;
    hold(CommandStage::kLowerTerm, order, kLowerTermTime);
  }
  void silence() {
    TestCommands::Order order;
    order.silent = true;
    hold(CommandStage::kSilence, order, kSilenceTime);
  }

  // Keeps the commands alive. Throws if somebody else commands the vehicle, or IMU samples cease.
  void renew() {
    commands_.renew();
    dialog_.require_going_on();
    const std::string other = recorder_.other_controller({commands_.term(), commands_.lower_term()});
    if (!other.empty()) throw std::runtime_error("stopped, rotors off: " + other);
    const auto now = Clock::now();
    if (now - renewed_ > kOwnStall) awake_since_ = now;
    renewed_ = now;
    const std::chrono::nanoseconds silence(recorder_.imu_silence_ns());
    if (std::min<Clock::duration>(silence, now - awake_since_) > kImuSilence)
      throw std::runtime_error(
          fmt::format("stopped, rotors off: no imu sample for {:g} s", kImuSilence.count()));
  }
  const CommandPhases& phases() const { return phases_; }

 private:
  using Clock = std::chrono::steady_clock;

  static std::uint32_t obeyed_term(const SampleRecorder& recorder) {
    const auto imu = recorder.newest_imu();
    return imu && imu->obeyed.any ? imu->obeyed.term : 0;
  }

  TestCommands::Order running(double throttle) const {
    TestCommands::Order order;
    order.state = plant::RotorState::kRunning;
    std::fill_n(order.throttle.begin(), rotor_count_, throttle);
    return order;
  }

  CommandPhase& hold(CommandStage stage, const TestCommands::Order& order, std::chrono::milliseconds time) {
    commands_.set(order);
    CommandPhase phase;
    phase.stage = stage;
    phase.term = order.lower_term ? commands_.lower_term() : commands_.term();
    phase.begin_ns = recorder_.now_ns();
    const std::int64_t end_ns = phase.begin_ns + std::chrono::nanoseconds(time).count();
    for (; recorder_.now_ns() < end_ns; std::this_thread::sleep_for(kPoll)) renew();
    phase.end_ns = recorder_.now_ns();
    return phases_.emplace_back(phase);
  }

  const SampleRecorder& recorder_;
  const OperatorDialog& dialog_;
  int rotor_count_;
  Clock::time_point renewed_ = Clock::now();
  Clock::time_point awake_since_ = renewed_;  // since when renew() is called regularly
  CommandPhases phases_;
  TestCommands commands_;  // last: ends with rotors off first
};

std::string rotor_list(const plant::Vehicle& vehicle) {
  std::string text;
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor)
    text += fmt::format("{}{} {}", rotor > 1 ? ", " : "", rotor,
                        place_of(vehicle.rotors[static_cast<std::size_t>(rotor - 1)]));
  return text;
}

// Asks what turns, with the rotor still turning.
void ask_person(CommandSequence& sequence, CommandPhase& spin, const plant::Vehicle& vehicle,
                const OperatorDialog& dialog) {
  const auto renew = [&] { sequence.renew(); };
  std::string numbers;
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor) numbers += std::to_string(rotor);
  spin.seen_rotor =
      dialog.ask(fmt::format("Which rotor turns faster? ({})", rotor_list(vehicle)), numbers, renew) - '0';
  spin.seen_spin = dialog.ask("Seen from above, clockwise (c) or counter-clockwise (a)?", "ca", renew) == 'c'
                       ? plant::Spin::kClockwise
                       : plant::Spin::kCounterClockwise;
}

// A vehicle that reports a command which it has just obeyed is flown by somebody.
bool obeys_somebody(const SampleRecorder& recorder) {
  const auto imu = recorder.newest_imu();
  return imu && imu->obeyed.any && imu->imu.stamp_ns - imu->obeyed.stamp_ns < kRecentCommand_ns;
}

// Throws std::runtime_error if somebody commands the vehicle.
void require_no_controller(const SampleRecorder& recorder) {
  std::string other = recorder.other_controller({});
  if (other.empty() && obeys_somebody(recorder))
    other = "the vehicle reports that it obeys commands of somebody";
  if (!other.empty()) throw std::runtime_error("refused to command the vehicle: " + other);
}

}  // namespace

CommandPhases command_without_propellers(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                         const plant::Vehicle& vehicle, const OperatorDialog& dialog) {
  require_no_controller(recorder);
  CommandSequence sequence(recorder, network, vehicle, dialog);
  dialog.say("rotors off, then idle");
  sequence.off(CommandStage::kOff, kOffTime);
  sequence.run(0.0, kIdleTime);
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor) {
    dialog.say(fmt::format("rotor {} of {} turns faster", rotor, vehicle.rotor_count()));
    CommandPhase& spin = sequence.raise(rotor, kSpinThrottle, 0.0, kSpinTime);
    if (dialog.has_terminal()) ask_person(sequence, spin, vehicle, dialog);
  }
  dialog.say("commands of a lower term, then none: the rotors must stop by themselves");
  sequence.run(0.0, kIdleTime);
  sequence.lower_term();
  sequence.run(0.0, kIdleTime);
  sequence.silence();
  sequence.run(0.0, kIdleTime);
  sequence.off(CommandStage::kStopped, kStopTime);
  return sequence.phases();
}

CommandPhases command_on_tether(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                const plant::Vehicle& vehicle, const OperatorDialog& dialog) {
  require_no_controller(recorder);
  const double hover_n = vehicle.mass_kg * plant::kGravity / vehicle.rotor_count();
  const double supply_v = vehicle.battery.open_circuit_voltage_v.back();
  const double common = plant::throttle_from_steady_thrust(vehicle, supply_v, kTetherThrust * hover_n);
  const double raised =
      plant::throttle_from_steady_thrust(vehicle, supply_v, (kTetherThrust + kTetherRaise) * hover_n);
  CommandSequence sequence(recorder, network, vehicle, dialog);
  dialog.say(fmt::format("all rotors at {:.0f} % of hover thrust, then each raised for a moment",
                         1e2 * kTetherThrust));
  sequence.off(CommandStage::kOff, kOffTime);
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor) {
    sequence.run(common, kTetherTime);
    sequence.raise(rotor, raised, common, kRaiseTime);
  }
  sequence.off(CommandStage::kStopped, kStopTime);
  return sequence.phases();
}

}  // namespace swiftlet::ground
