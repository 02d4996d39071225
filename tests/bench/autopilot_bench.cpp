// Latency between swiftlet-plant and an autopilot over MAVLink: from an IMU sample to the controls that answer it. The
// autopilot is that of the tests, whose computation takes some microseconds; the rest is the link.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <termios.h>
#include <unistd.h>
#include <vector>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/scripted_autopilot.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  double seconds = 5.0;
  runtime::ProcessOptions process;
};

// One flight, with the plant's own figures.
class Flight {
 public:
  explicit Flight(std::vector<std::string> arguments)
      : watcher_(settings(lock_.domain())),
        info_(watcher_.subscribe<messages::msg::VehicleInfo>(messages::topics::kVehicleInfo,
                                                             [this](const auto& info) {
                                                               const std::lock_guard<std::mutex> lock(mutex_);
                                                               newest_ = info;
                                                             })) {
    arguments.insert(arguments.end(), {"--autopilot", "mavlink", "--domain", std::to_string(lock_.domain()),
                                       "--localhost-only"});
    plant_ = std::make_unique<tests::Program>("swiftlet-plant", arguments, folder_.path());
  }

  tests::ScriptedAutopilot& autopilot() { return autopilot_; }

  void wait_until_ready() const {
    if (!tests::eventually([&] { return plant_->errors().find("ready: ") != std::string::npos; }))
      throw std::runtime_error("swiftlet-plant did not start: " + plant_->errors());
  }
  void fly_for(double seconds) {
    if (!autopilot_.fly_until(0.001, tests::kStuck)) fail();
    const double start_s = static_cast<double>(autopilot_.log().sensor_times_us.front()) * 1e-6;
    if (!autopilot_.fly_until(start_s + seconds, tests::kStuck)) fail();
  }
  // Flies on until vehicle_info has come that was sent after `seconds` by the autopilot's clock.
  messages::msg::VehicleInfo info() {
    const double now_s = static_cast<double>(autopilot_.log().sensor_times_us.back()) * 1e-6;
    for (double time_s = now_s; time_s < now_s + 60.0; time_s += 0.1) {
      if (!autopilot_.fly_until(time_s, tests::kStuck)) fail();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (static_cast<double>(newest_.stamp_ns()) * 1e-9 > now_s) return newest_;
    }
    throw std::runtime_error("no vehicle_info has come");
  }

 private:
  static dds::NodeSettings settings(int domain) {
    dds::NodeSettings settings;
    settings.name = "bench";
    settings.domain = domain;
    return settings;
  }
  static tests::ScriptedAutopilotSettings pilot_settings() {
    tests::ScriptedAutopilotSettings settings;
    settings.lockstep = true;
    return settings;
  }
  [[noreturn]] void fail() const { throw std::runtime_error("the flight ended: " + plant_->errors()); }

  dds::DomainLock lock_;
  tests::TemporaryFolder folder_;
  dds::Node watcher_;
  std::mutex mutex_;
  messages::msg::VehicleInfo newest_;
  dds::Subscription info_;
  std::unique_ptr<tests::Program> plant_;
  tests::ScriptedAutopilot autopilot_{io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
                                      plant::SiteSettings(), pilot_settings()};
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void print_latency(const char* link, Flight& flight) {
  const messages::msg::VehicleInfo info = flight.info();
  std::printf(
      "%-28s sense to actuate p50 %4.0f us, p99 %4.0f us, max %5.0f us; of it in the autopilot %2.0f us\n",
      link, info.sense_to_actuate_p50_us(), info.sense_to_actuate_p99_us(), info.sense_to_actuate_max_us(),
      median(flight.autopilot().log().answer_times_us));
}

void measure_tcp(double seconds) {
  const int port = tests::free_tcp_port();
  Flight flight({"--autopilot-port", std::to_string(port)});
  if (!flight.autopilot().connect(port, tests::kStuck)) throw std::runtime_error("cannot connect");
  flight.fly_for(seconds);
  print_latency("TCP on one host, 500 Hz:", flight);
}

void measure_serial(double seconds) {
  const int board = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (board < 0 || ::grantpt(board) != 0 || ::unlockpt(board) != 0)
    throw std::runtime_error("no pseudo-terminal");
  const std::string device = ::ptsname(board);
  Flight flight({"--autopilot-device", device});
  flight.wait_until_ready();
  flight.autopilot().use(board);
  flight.fly_for(seconds);
  print_latency("pseudo-terminal, 500 Hz:", flight);
}

void measure_lockstep(double seconds) {
  const int port = tests::free_tcp_port();
  Flight flight({"--autopilot-port", std::to_string(port), "--clock", "lockstep"});
  if (!flight.autopilot().connect(port, tests::kStuck)) throw std::runtime_error("cannot connect");
  flight.fly_for(1.0);
  const auto start = Clock::now();
  flight.fly_for(1.0 + seconds);
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
  std::printf("%-28s %.1f times real time\n", "lockstep over TCP, 500 Hz:", seconds / elapsed_s);
}

void run(const Options& options) {
  const runtime::Logging logging("autopilot_bench", options.process.log);
  measure_tcp(options.seconds);
  measure_serial(options.seconds);
  measure_lockstep(4.0 * options.seconds);
}

}  // namespace
}  // namespace swiftlet

int main(int argc, char** argv) {
  using namespace swiftlet;
  Options options;
  return runtime::run_process(
      {"autopilot_bench", "Measures the link between swiftlet-plant and an autopilot.", "--seconds 5"}, argc,
      argv,
      [&](runtime::CommandLine app) {
        app.add_option("--seconds", options.seconds, "Length of each flight, s")
            .range(1.0, 600.0)
            .show_default();
        runtime::add_process_options(app, options.process);
      },
      [&] { run(options); });
}
