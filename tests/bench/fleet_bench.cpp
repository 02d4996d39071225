// The messages of a fleet without model and controller: the load and the lateness that the middleware alone causes.
// Processes, participants, endpoints and threads are those of swiftlet-plant, swiftlet-mocap and swiftlet-control.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/plant/answer_latencies.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/bench/process_usage.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet {
namespace {

using namespace std::chrono_literals;
namespace topics = messages::topics;
namespace msg = messages::msg;

constexpr std::int64_t kPeriodNs = 2'000'000;
constexpr int kSamplesPerPose = 5;

struct Options {
  int vehicles = 8;
  double seconds = 5.0;
  bool json = false;
  runtime::ProcessOptions process;
};

dds::NodeSettings settings(const char* name, int domain, const runtime::RealtimeSettings& realtime) {
  dds::NodeSettings settings;
  settings.name = name;
  settings.domain = domain;
  settings.realtime_priority = realtime.thread_priority();
  return settings;
}

std::vector<std::string> names(int vehicles) {
  std::vector<std::string> all;
  for (int i = 1; i <= vehicles; ++i) all.push_back("kl" + std::to_string(i));
  return all;
}

// Answers each IMU sample of its vehicle with a command.
struct Control {
  Control(const dds::Participant& participant, const std::string& name,
          const runtime::RealtimeSettings& realtime)
      : node(participant, name), commands(node.publish(topics::kActuatorCommand)) {
    poses = node.subscribe<msg::MocapPose>(
        topics::kMocapPose, [](const auto&) {}, dds::Delivery::kSensors);
    rotor_speeds = node.subscribe<msg::RotorSpeeds>(
        topics::kRotorSpeeds, [this, realtime](const auto&) { rotor_speed_thread.enter(realtime); },
        dds::Delivery::kSensors);
    samples = node.subscribe<msg::Imu>(
        topics::kImu,
        [this, realtime](const msg::Imu& imu) {
          thread.enter(realtime);
          command.imu_sequence_number(imu.sequence_number());
          commands.publish(command);
        },
        dds::Delivery::kSamples);
  }
  dds::Node node;
  dds::Publisher<msg::ActuatorCommand> commands;
  msg::ActuatorCommand command;
  runtime::RealtimeThread thread, rotor_speed_thread;
  dds::Subscription poses, rotor_speeds, samples;
};

// Answers each truth of its vehicle with a pose.
struct Mocap {
  Mocap(const dds::Participant& participant, const std::string& name,
        const runtime::RealtimeSettings& realtime)
      : node(participant, name), poses(node.publish(topics::kMocapPose)) {
    truth = node.subscribe<msg::GroundTruth>(
        topics::kGroundTruth,
        [this, realtime](const msg::GroundTruth& sample) {
          thread.enter(realtime);
          pose.sequence_number(sample.sequence_number());
          poses.publish(pose);
        },
        dds::Delivery::kSamples);
  }
  dds::Node node;
  dds::Publisher<msg::MocapPose> poses;
  msg::MocapPose pose;
  runtime::RealtimeThread thread;
  dds::Subscription truth;
};

// Publishes IMU samples of its vehicle, for every fifth one truth and rotor speeds, and counts late answers.
class Plant {
 public:
  Plant(const dds::Participant& participant, const std::string& name,
        const runtime::RealtimeSettings& realtime)
      : node_(participant, name),
        imu_(node_.publish(topics::kImu)),
        truth_(node_.publish(topics::kGroundTruth)),
        rotor_speeds_(node_.publish(topics::kRotorSpeeds)) {
    commands_ = node_.subscribe<msg::ActuatorCommand>(
        topics::kActuatorCommand,
        [this, realtime](const msg::ActuatorCommand& command) {
          receiver_.enter(realtime);
          const std::lock_guard<std::mutex> lock(mutex_);
          answers_.answered(command.imu_sequence_number(), runtime::monotonic_ns());
        },
        dds::Delivery::kSamples);
  }
  void publish() {
    ++sequence_;
    imu_message_.sequence_number(sequence_);
    truth_message_.sequence_number(sequence_);
    rotor_speeds_message_.sequence_number(sequence_);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      answers_.written(sequence_, runtime::monotonic_ns());
    }
    imu_.publish(imu_message_);
    if (sequence_ % kSamplesPerPose != 0) return;
    truth_.publish(truth_message_);
    rotor_speeds_.publish(rotor_speeds_message_);
  }

  bool connected() const { return imu_.matched() == 1 && truth_.matched() == 1 && commands_.matched() == 1; }
  void reset() {
    const std::lock_guard<std::mutex> lock(mutex_);
    answers_.reset();
  }
  double overdue_percent() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto all = static_cast<double>(answers_.times().count() + answers_.unanswered());
    return all > 0.0 ? 100.0 * static_cast<double>(answers_.late() + answers_.unanswered()) / all : 100.0;
  }
  double p99_us() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return 1e-3 * static_cast<double>(answers_.times().quantile_ns(0.99));
  }

 private:
  dds::Node node_;
  dds::Publisher<msg::Imu> imu_;
  dds::Publisher<msg::GroundTruth> truth_;
  dds::Publisher<msg::RotorSpeeds> rotor_speeds_;
  std::mutex mutex_;  // guards answers_
  services::AnswerLatencies answers_{kPeriodNs};
  runtime::RealtimeThread receiver_;
  std::uint64_t sequence_ = 0;
  msg::Imu imu_message_;
  msg::GroundTruth truth_message_;
  msg::RotorSpeeds rotor_speeds_message_;
  dds::Subscription commands_;
};

template <class Vehicle>
std::vector<std::unique_ptr<Vehicle>> serve(const dds::Participant& participant, int vehicles,
                                            const runtime::RealtimeSettings& realtime) {
  std::vector<std::unique_ptr<Vehicle>> all;
  for (const std::string& name : names(vehicles))
    all.push_back(std::make_unique<Vehicle>(participant, name, realtime));
  return all;
}

// Publishes the samples of all vehicles in one thread, as swiftlet-plant does.
class Stepping {
 public:
  Stepping(const std::vector<std::unique_ptr<Plant>>& vehicles, const runtime::RealtimeSettings& realtime)
      : thread_([this, &vehicles, realtime] {
          if (realtime.enabled) runtime::make_this_thread_realtime(realtime);
          runtime::PeriodicTimer timer(kPeriodNs, kPeriodNs);
          while (!end_) {
            timer.wait();
            for (const auto& vehicle : vehicles) vehicle->publish();
          }
        }) {}
  ~Stepping() {
    end_ = true;
    thread_.join();
  }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

 private:
  std::atomic<bool> end_{false};
  std::thread thread_;
};

// A child process that serves all vehicles until its end.
template <class Vehicle>
class ServingProcess {
 public:
  ServingProcess(const char* name, int domain, const Options& options) {
    if (::pipe(pipe_.data()) != 0) throw std::runtime_error("no pipe");
    pid_ = ::fork();
    if (pid_ == 0) serve_until_closed(name, domain, options);
    ::close(pipe_[0]);
  }
  ~ServingProcess() {
    ::close(pipe_[1]);
    ::waitpid(pid_, nullptr, 0);
  }
  ServingProcess(const ServingProcess&) = delete;
  ServingProcess& operator=(const ServingProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool has_ended() const {
    siginfo_t ended{};
    return ::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           ended.si_pid == pid_;
  }

 private:
  [[noreturn]] void serve_until_closed(const char* name, int domain, const Options& options) {
    ::close(pipe_[1]);
    const runtime::RealtimeSettings realtime =
        runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);
    const dds::Participant participant(settings(name, domain, realtime), names(options.vehicles));
    const auto vehicles = serve<Vehicle>(participant, options.vehicles, realtime);
    char byte = 0;
    while (::read(pipe_[0], &byte, 1) > 0) {
    }
    std::_Exit(0);
  }

  std::array<int, 2> pipe_{};
  pid_t pid_ = -1;
};

void run(const Options& options) {
  runtime::log_to_stderr("bench");
  const dds::DomainLock lock;
  const ServingProcess<Control> control("control", lock.domain(), options);
  const ServingProcess<Mocap> mocap("mocap", lock.domain(), options);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);
  const dds::Participant participant(settings("plant", lock.domain(), realtime), names(options.vehicles));
  const auto vehicles = serve<Plant>(participant, options.vehicles, realtime);
  for (const auto& vehicle : vehicles) {
    if (!tests::eventually([&] { return vehicle->connected(); }))
      throw std::runtime_error("the processes did not discover each other");
  }
  const Stepping stepping(vehicles, realtime);
  const auto usage = [&] {
    Usage all;
    for (const pid_t pid : {control.pid(), mocap.pid(), ::getpid()}) {
      const Usage one = usage_of(pid);
      all.cpu_s += one.cpu_s;
      all.threads += one.threads;
      all.switches += one.switches;
    }
    return all;
  };
  for (const auto& vehicle : vehicles) vehicle->reset();
  const auto start = std::chrono::steady_clock::now();
  const Usage before = usage();
  const auto window = std::chrono::milliseconds(std::lround(1e3 * options.seconds));
  if (tests::eventually([&] { return control.has_ended() || mocap.has_ended(); }, window, 100ms))
    throw std::runtime_error("a process ended while the messages were measured");
  const double passed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Usage after = usage();
  const double cpu_percent = 100.0 * (after.cpu_s - before.cpu_s) / passed_s;
  const double switches_per_s = (after.switches - before.switches) / passed_s;
  double overdue_percent = 0.0;
  double p99_us = 0.0;
  for (const auto& vehicle : vehicles) {
    overdue_percent = std::max(overdue_percent, vehicle->overdue_percent());
    p99_us = std::max(p99_us, vehicle->p99_us());
  }
  if (options.json) {
    const nlohmann::ordered_json row{{"vehicles", options.vehicles},       {"cpu_percent", cpu_percent},
                                     {"threads", after.threads},           {"switches_per_s", switches_per_s},
                                     {"overdue_percent", overdue_percent}, {"p99_us", p99_us}};
    std::printf("%s\n", row.dump().c_str());
  } else {
    std::printf(
        "%d vehicles: %.1f %% of a core, %d threads, %.0f context switches/s, %.3f %% of the answers after a "
        "period, p99 %.0f us\n",
        options.vehicles, cpu_percent, after.threads, switches_per_s, overdue_percent, p99_us);
  }
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"fleet_bench",
       "Exchanges the messages of vehicles between three processes, without model and controller.",
       "--vehicles 16 --seconds 10"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--vehicles", options.vehicles, "number of vehicles").range(1, 50);
        app.add_option("--seconds", options.seconds, "duration, s").range(0.1, 3600.0);
        app.add_flag("--json", options.json, "print JSON");
        runtime::add_process_options(app, options.process);
      },
      [&] { run(options); });
}
