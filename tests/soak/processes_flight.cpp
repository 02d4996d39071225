#include "tests/soak/processes_flight.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::soak {
namespace {

using namespace std::chrono_literals;
using tests::eventually;
using tests::Program;
using Clock = std::chrono::steady_clock;
using ControlMode = control::Mode;
namespace msg = messages::msg;

constexpr double kHeight_m = 1.0;
constexpr double kHalfSide_m = 0.5;
constexpr auto kEndsWithin = 20s;  // the longest fate: a descent
constexpr auto kFliesOn = 2s;      // from the end of the failure
constexpr auto kQuiet = 1s;        // without a command, and without rotors
constexpr double kFall_m_s = 1.2;  // faster than any descent

constexpr std::array<const char*, 4> kProcessNames{"plant", "mocap", "control", "ground"};
constexpr std::array<const char*, 3> kFailureNames{"killed", "hung", "restarted"};

std::vector<ProcessCase> all_cases() {
  using Fates = std::array<Fate, 3>;  // by ProcessFailure
  const std::array<Fates, 4> fates{{
      {Fate::kGone, Fate::kFliesOn, Fate::kStaysOff},  // plant
      {Fate::kLands, Fate::kLands, Fate::kLands},      // mocap
      {Fate::kFalls, Fate::kFalls, Fate::kFalls},      // control
      {Fate::kLands, Fate::kLands, Fate::kLands},      // ground
  }};
  std::vector<ProcessCase> all;
  for (std::size_t process = 0; process < fates.size(); ++process) {
    for (std::size_t failure = 0; failure < fates[process].size(); ++failure) {
      for (const plant::ControlLevel level : plant::kControlLevels)
        all.push_back({static_cast<FlightProcess>(process), static_cast<ProcessFailure>(failure), level,
                       fates[process][failure]});
    }
  }
  return all;
}

std::string write_laps(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "laps.yaml";
  std::ofstream file(path);
  file << "name: laps\nframe: ned\ntolerance_m: 0.2\nitems:\n"
       << fmt::format("  - {{kind: takeoff, height_m: {}, speed_m_s: 1.0}}\n", kHeight_m);
  for (int lap = 0; lap < 20; ++lap) {
    for (const auto& [x, y] : {std::pair{1, 1}, {1, -1}, {-1, -1}, {-1, 1}})
      file << fmt::format("  - {{kind: waypoint, position_m: [{}, {}, {}], speed_m_s: 1.0}}\n",
                          x * kHalfSide_m, y * kHalfSide_m, -kHeight_m);
  }
  file << "  - {kind: land, speed_m_s: 0.5}\n";
  return path.string();
}

class FailingFlight {
 public:
  FailingFlight(plant::ControlLevel level, double speed, const std::filesystem::path& folder)
      : level_(level),
        speed_(speed),
        folder_(folder),
        mission_(write_laps(folder)),
        observer_(node("observer")),
        watcher_(std::make_unique<dds::Node>(node("watcher"))) {
    hear_commands();
  }

  // Starts the processes that do not run, and waits until the vehicle flies the mission.
  void begin() {
    program(FlightProcess::kGround).reset();
    for (const FlightProcess process :
         {FlightProcess::kPlant, FlightProcess::kMocap, FlightProcess::kControl}) {
      if (is_dead(process)) start(process);
    }
    require(
        [this] {
          const ground::View view = observer_.view();
          return view.control.message.has_pose() && view.battery.seen() && view.truth.seen();
        },
        "control is ready");
    if (mode() == ControlMode::kStopped) {
      control::Request disarm;
      disarm.kind = control::RequestKind::kDisarm;
      require([&] { return observer_.request(disarm, 5s).accepted(); }, "it can be disarmed");
    }
    start(FlightProcess::kGround);
    require(
        [this] {
          const auto v = truth().velocity_ned();
          return height_m() > kHeight_m - 0.05 && std::hypot(v[0], v[1]) > 0.4;
        },
        "it flies the mission");
  }

  ProcessResult fail(const ProcessCase& one) {
    case_ = one;
    result_ = {};
    fastest_fall_m_s_ = 0.0;
    const std::int64_t stamp_ns = truth().stamp_ns();
    kill_or_stop();
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(kProcessAway_s));
    if (case_.failure != ProcessFailure::kKilled) {
      watch_until([&] { return Clock::now() >= end; });
      come_back();
    }
    const auto over = Clock::now();
    if (case_.process != FlightProcess::kPlant) {
      result_.fate = fate_of_flight(over);
    } else if (case_.failure == ProcessFailure::kHung) {
      result_.fate = fate_of_flight(over, stamp_ns);
    } else {
      result_.fate = fate_without_vehicle(over);
    }
    result_.reason =
        is_dead(FlightProcess::kControl) ? "" : observer_.view().control.message.reason().c_str();
    if (case_.process == FlightProcess::kGround && case_.failure == ProcessFailure::kRestarted)
      result_.ground_fault = fault_of_ground();
    return result_;
  }

 private:
  dds::NodeSettings node(const char* name) const {
    dds::NodeSettings settings;
    settings.name = name;
    settings.domain = lock_.domain();
    return settings;
  }

  std::unique_ptr<Program>& program(FlightProcess process) {
    return programs_[static_cast<std::size_t>(process)];
  }
  bool is_dead(FlightProcess process) {
    return !program(process) || program(process)->exit_code().has_value();
  }

  void start(FlightProcess process) {
    std::vector<std::string> words;
    std::string name = std::string("swiftlet-") + kProcessNames[static_cast<std::size_t>(process)];
    const char* const level = plant::to_string(level_);
    if (process == FlightProcess::kPlant || process == FlightProcess::kControl) words = {"--level", level};
    if (process == FlightProcess::kPlant) words.insert(words.end(), {"--speed", fmt::format("{:g}", speed_)});
    if (process == FlightProcess::kGround) {
      name = "swiftlet";
      const std::string record = (folder_ / fmt::format("record{}", ++records_)).string();
      words = {"fly", mission_, "--attach", "--skip-check", "--record", record};
    }
    words.insert(words.end(), {"--domain", std::to_string(lock_.domain()), "--localhost-only"});
    program(process) = std::make_unique<Program>(name, words, folder_);
  }

  // Any command of the level.
  void hear_commands() {
    const auto subscribe = [this](const auto& topic) {
      using Message = typename std::decay_t<decltype(topic)>::Message;
      commands_ = watcher_->subscribe<Message>(topic, [this](const Message&) {
        commanded_.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed);
      });
    };
    switch (level_) {
      case plant::ControlLevel::kActuators:
        return subscribe(messages::topics::kActuatorCommand);
      case plant::ControlLevel::kRates:
        return subscribe(messages::topics::kRatesSetpoint);
      case plant::ControlLevel::kAttitude:
        return subscribe(messages::topics::kAttitudeSetpoint);
      case plant::ControlLevel::kTrajectory:
        return subscribe(messages::topics::kTrajectorySetpoint);
    }
  }
  Clock::time_point commanded() const {
    return Clock::time_point(Clock::duration(commanded_.load(std::memory_order_relaxed)));
  }

  void require(const std::function<bool()>& holds, const char* what) {
    if (eventually(holds, tests::kStuck, 5ms)) return;
    std::string errors;
    for (const auto& one : programs_) {
      if (one) errors += one->errors();
    }
    throw std::runtime_error(std::string(what) + ": no\n" + errors);
  }

  void kill_or_stop() {
    Program& failing = *program(case_.process);
    failing.signal(case_.failure == ProcessFailure::kHung ? SIGSTOP : SIGKILL);
    if (case_.failure != ProcessFailure::kHung) failing.wait(5s);
  }
  void come_back() {
    if (case_.failure == ProcessFailure::kHung) return program(case_.process)->signal(SIGCONT);
    start(case_.process);
  }

  msg::GroundTruth truth() const { return observer_.view().truth.message; }
  double height_m() const { return -truth().position_ned()[2]; }
  ControlMode mode() const { return static_cast<ControlMode>(observer_.view().control.message.mode()); }

  // Notes the motion until the predicate holds. Returns false after kEndsWithin.
  bool watch_until(const std::function<bool()>& predicate) {
    return eventually(
        [&] {
          note();
          return predicate();
        },
        kEndsWithin, 5ms);
  }
  void note() {
    const msg::GroundTruth now = truth();
    if (now.on_ground()) return;
    const auto& p = now.position_ned();
    result_.climb_m = std::max(result_.climb_m, -p[2] - kHeight_m);
    result_.sideways_m = std::max(result_.sideways_m, std::max(std::abs(p[0]), std::abs(p[1])) - kHalfSide_m);
    fastest_fall_m_s_ = std::max(fastest_fall_m_s_, now.velocity_ned()[2]);
  }

  std::optional<Fate> fate_of_flight(Clock::time_point over, std::int64_t after_ns = 0) {
    std::optional<Fate> fate;
    watch_until([&] {
      const msg::GroundTruth now = truth();
      const bool rotors_off = !observer_.view().vehicle.message.rotors_running();
      if (now.on_ground() && rotors_off) {
        fate = fastest_fall_m_s_ > kFall_m_s ? Fate::kFalls : Fate::kLands;
      } else if (Clock::now() - over > kFliesOn && mode() == ControlMode::kMission &&
                 case_.failure != ProcessFailure::kKilled && now.stamp_ns() > after_ns + 1'000'000'000) {
        fate = Fate::kFliesOn;
      }
      return fate.has_value();
    });
    return fate;
  }

  // Gone if nothing is commanded any more; off if it is there again and does not obey.
  std::optional<Fate> fate_without_vehicle(Clock::time_point over) {
    const bool killed = case_.failure == ProcessFailure::kKilled;
    const bool quiet = eventually(
        [&] {
          const ground::View view = observer_.view();
          const bool heard = view.vehicle.seen() && view.vehicle.received > over;
          if (killed) return Clock::now() - std::max(commanded(), over - kQuiet) > kQuiet && !heard;
          if (!heard || view.vehicle.message.rotors_running()) return false;
          return view.vehicle.message.stamp_ns() > std::chrono::nanoseconds(kQuiet).count();
        },
        kEndsWithin, 5ms);
    if (!quiet || (killed && commanded() > over + 100ms)) return std::nullopt;
    return killed ? Fate::kGone : Fate::kStaysOff;
  }

  std::string fault_of_ground() {
    Program& ground = *program(FlightProcess::kGround);
    if (ground.wait(20s) <= 0) return "";
    const std::string errors = ground.errors();
    return errors.substr(0, errors.find('\n'));
  }

  const plant::ControlLevel level_;
  const double speed_;
  const std::filesystem::path folder_;
  const std::string mission_;
  dds::DomainLock lock_;
  std::array<std::unique_ptr<Program>, 4> programs_;
  int records_ = 0;
  ground::Client observer_;
  ProcessCase case_{};
  ProcessResult result_;
  double fastest_fall_m_s_ = 0.0;
  std::atomic<Clock::rep> commanded_{0};
  std::unique_ptr<dds::Node> watcher_;
  dds::Subscription commands_;
};

}  // namespace

const char* to_string(Fate fate) {
  switch (fate) {
    case Fate::kFliesOn:
      return "flies on";
    case Fate::kLands:
      return "lands";
    case Fate::kFalls:
      return "falls";
    case Fate::kGone:
      return "gone";
    case Fate::kStaysOff:
      return "stays off";
  }
  return "";
}

std::string ProcessCase::name() const {
  return fmt::format("{} {}, level {}", kProcessNames.at(static_cast<std::size_t>(process)),
                     kFailureNames.at(static_cast<std::size_t>(failure)), plant::to_string(level));
}

const std::vector<ProcessCase>& process_cases() {
  static const std::vector<ProcessCase> all = all_cases();
  return all;
}

std::vector<ProcessResult> fly_with_failures(const std::vector<ProcessCase>& cases,
                                             const std::filesystem::path& folder, double speed) {
  FailingFlight flight(cases.front().level, speed, folder);
  std::vector<ProcessResult> results;
  for (const ProcessCase& one : cases) {
    flight.begin();
    results.push_back(flight.fail(one));
  }
  return results;
}

}  // namespace swiftlet::soak
