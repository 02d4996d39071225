#include "tests/unit/ground/vehicle_check/recorded_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/command_watchdog.hpp"
#include "swiftlet/plant/simulation/imu.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/support/hand_path.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

using ground::CommandPhase;
using ground::CommandStage;
using ground::HandStep;
using ground::VehicleRecording;

constexpr std::uint64_t kSeed = 4;
constexpr std::int64_t kPeriod_ns = 2'000'000;
constexpr std::int64_t kClockOffset_ns = 700'000'000'000;  // computer's clock minus vehicle's clock
constexpr std::int64_t kWay_ns = 300'000;                  // of a sample
constexpr std::int64_t kFirstStamp_ns = 5'000'000'000;
constexpr double kVoltage_v = 4.1;

std::int64_t arrival(std::int64_t stamp_ns) { return stamp_ns + kClockOffset_ns + kWay_ns; }

void describe(VehicleRecording& recording) {
  recording.imu.published = recording.battery.published = recording.mocap.published =
      recording.rotor_speeds.published = true;
  recording.description = ground::VehicleDescription{"kaylion", false, 4, 0.040, 500.0};
}

void add_slow_samples(VehicleRecording& recording, std::int64_t stamp_ns, std::uint64_t number) {
  if (number % 50 == 0)
    recording.battery.samples.push_back(
        {{stamp_ns, number / 50 + 1, kVoltage_v, 0.1, 0.9}, arrival(stamp_ns)});
  if (number % 25 == 0) {
    const std::int64_t sent_ns = arrival(stamp_ns);
    recording.clock.push_back({sent_ns, sent_ns - kClockOffset_ns + kWay_ns,
                               sent_ns - kClockOffset_ns + kWay_ns, sent_ns + 2 * kWay_ns});
  }
}

// Sensors of a vehicle that follows a path.
class CarriedVehicle {
 public:
  CarriedVehicle() : imu_({}, kSeed), mocap_({}, kSeed) {}

  VehicleRecording record(const HandPath& path, std::int64_t begin_ns, std::int64_t end_ns) {
    VehicleRecording recording;
    describe(recording);
    recording.begin_ns = arrival(begin_ns);
    recording.end_ns = arrival(end_ns);
    for (std::int64_t stamp_ns = begin_ns; stamp_ns < end_ns; stamp_ns += kPeriod_ns)
      sample(path, stamp_ns, recording);
    return recording;
  }

 private:
  void sample(const HandPath& path, std::int64_t stamp_ns, VehicleRecording& recording) {
    const double time_s = math::seconds(stamp_ns);
    ground::ImuReport report;
    report.imu = imu_.sample(stamp_ns, path.specific_force_frd(time_s), path.body_rates_frd(time_s));
    report.obeyed.reported = true;
    recording.imu.samples.push_back({report, arrival(stamp_ns)});
    const HandPose pose = path.at(time_s);
    if (const auto frame = mocap_.update(stamp_ns, pose.position_ned, pose.q_ned_from_frd))
      recording.mocap.samples.push_back({*frame, arrival(stamp_ns)});
    recording.rotor_speeds.samples.push_back({{stamp_ns, report.imu.sequence, 4, {}}, arrival(stamp_ns)});
    add_slow_samples(recording, stamp_ns, report.imu.sequence - 1);
  }

  plant::Imu imu_;
  plant::Mocap mocap_;
};

HandPose start() {
  return {{0.4, -0.2, -0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()))};
}

// Commands a simulated vehicle step by step, and records it.
class CommandedVehicle {
 public:
  CommandedVehicle(const plant::Vehicle& vehicle, const plant::SimulationSettings& settings,
                   const CommandDefects& defects)
      : defects_(defects),
        simulation_(vehicle, settings, kSeed),
        watchdog_(4, defects.ignores_timeout ? 1'000'000'000'000 : 500'000'000) {
    describe(record_.recording);
    record_.recording.begin_ns = arrival(0);
  }

  void off(CommandStage stage, double time_s, std::uint32_t term = kTerm) {
    command_ = {};
    command_.term = term;
    hold(stage, time_s);
  }
  void run(double throttle, double time_s) {
    command_ = {};
    command_.rotor_state = plant::RotorState::kRunning;
    std::fill_n(command_.throttle.begin(), 4, throttle);
    command_.term = kTerm;
    hold(CommandStage::kIdle, time_s);
  }
  void raise(int rotor, double throttle, double of_others, double time_s) {
    command_ = {};
    command_.rotor_state = plant::RotorState::kRunning;
    std::fill_n(command_.throttle.begin(), 4, of_others);
    command_.throttle[static_cast<std::size_t>(rotor - 1)] = throttle;
    command_.term = kTerm;
    hold(CommandStage::kSpin, time_s);
    record_.phases.back().rotor = rotor;
  }
  void silence(double time_s) {
    silent_ = true;
    hold(CommandStage::kSilence, time_s);
    silent_ = false;
  }
  RecordedCommands end() {
    record_.recording.end_ns = arrival(simulation_.stamp_ns());
    return record_;
  }

  static constexpr std::uint32_t kTerm = 3 << 16;

 private:
  void hold(CommandStage stage, double time_s) {
    const std::int64_t begin_ns = simulation_.stamp_ns();
    while (simulation_.stamp_ns() < begin_ns + std::llround(time_s * 1e9)) step();
    record_.phases.push_back({stage, command_.term, arrival(begin_ns), arrival(simulation_.stamp_ns())});
  }

  void step() {
    if (simulation_.imu() && !silent_ && !defects_.is_deaf) obey();
    plant::MotorCommand drive = watchdog_.motor_command(simulation_.stamp_ns());
    const plant::MotorCommand given = drive;
    for (std::size_t i = 0; i < 4; ++i)
      drive.throttle[static_cast<std::size_t>(defects_.rotor_of[i] - 1)] = given.throttle[i];
    if (defects_.turns_while_off) drive.state = plant::RotorState::kRunning;
    const bool idle = *std::max_element(drive.throttle.begin(), drive.throttle.end()) < 0.01;
    if (defects_.idles_off && idle) drive.state = plant::RotorState::kOff;
    simulation_.step(drive);
    record();
  }

  void obey() {
    plant::ActuatorCommand command = command_;
    command.rotor_count = 4;
    command.stamp_ns = simulation_.stamp_ns();
    if (watchdog_.accept(command, simulation_.stamp_ns()) == plant::CommandFault::kNone)
      obeyed_ = watchdog_.obeyed();
    // A vehicle that does not look at the term: shows that of the newest command.
    if (defects_.obeys_lower_terms) obeyed_ = {true, true, command.term, command.stamp_ns};
  }

  void record() {
    const std::int64_t now_ns = arrival(simulation_.stamp_ns());
    VehicleRecording& recording = record_.recording;
    if (simulation_.imu()) {
      ground::ImuReport report{*simulation_.imu(), obeyed_};
      report.obeyed.reported = !defects_.reports_nothing;
      recording.imu.samples.push_back({report, now_ns});
    }
    if (simulation_.rotor_speeds())
      recording.rotor_speeds.samples.push_back({*simulation_.rotor_speeds(), now_ns});
  }

  CommandDefects defects_;
  plant::PlantSimulation simulation_;
  plant::CommandWatchdog watchdog_;
  plant::ActuatorCommand command_;
  plant::ObeyedCommand obeyed_{true, false, 0, 0};
  bool silent_ = false;
  RecordedCommands record_;
};

}  // namespace

plant::Vehicle kaylion() { return io::load_vehicle(in_source("config/vehicles/kaylion.yaml")); }

VehicleRecording record_standing() {
  return CarriedVehicle().record(HandPath(start()), kFirstStamp_ns, kFirstStamp_ns + 2'000'000'000);
}

RecordedHand record_hand() {
  constexpr double kRest_s = 1.0;
  HandPath path(start());
  RecordedHand hand;
  double time_s = math::seconds(kFirstStamp_ns) + 2.0;
  for (const HandStep step : {HandStep::kRollRight, HandStep::kBack, HandStep::kNoseUp, HandStep::kBack,
                              HandStep::kTurnRight, HandStep::kForward, HandStep::kUp, HandStep::kWave}) {
    const double begin_s = time_s;
    time_s = path.move(step, begin_s + kRest_s) + kRest_s;
    hand.segments.push_back(
        {step, arrival(std::llround(begin_s * 1e9)), arrival(std::llround(time_s * 1e9))});
  }
  const std::int64_t moved_ns = kFirstStamp_ns + 2'000'000'000;
  CarriedVehicle vehicle;
  hand.rest = vehicle.record(path, kFirstStamp_ns, moved_ns);
  hand.motion = vehicle.record(path, moved_ns, std::llround(time_s * 1e9));
  return hand;
}

RecordedCommands record_commands(const CommandDefects& defects) {
  CommandedVehicle vehicle(kaylion(), {}, defects);
  vehicle.off(CommandStage::kOff, 0.7);
  vehicle.run(0.0, 1.2);
  for (int rotor = 1; rotor <= 4; ++rotor) vehicle.raise(rotor, 0.15, 0.0, 1.0);
  vehicle.run(0.0, 1.2);
  vehicle.off(CommandStage::kLowerTerm, 0.15, CommandedVehicle::kTerm - 1);
  vehicle.run(0.0, 1.2);
  vehicle.silence(1.8);
  vehicle.run(0.0, 1.2);
  vehicle.off(CommandStage::kStopped, 1.5);
  return vehicle.end();
}

RecordedCommands record_thrusts(const plant::Vehicle& built, const std::vector<int>& rotor_of) {
  plant::SimulationSettings settings;
  settings.ground.present = false;
  CommandDefects order;
  order.rotor_of = rotor_of;
  CommandedVehicle vehicle(built, settings, order);
  vehicle.off(CommandStage::kOff, 0.7);
  for (int rotor = 1; rotor <= 4; ++rotor) {
    vehicle.run(0.2, 0.8);
    vehicle.raise(rotor, 0.25, 0.2, 0.15);
  }
  vehicle.off(CommandStage::kStopped, 0.5);
  return vehicle.end();
}

}  // namespace swiftlet::tests
