// swiftlet-vehicle-template: a vehicle process, to be copied for a vehicle of your own. It joins a microcontroller, over a
// serial device or UDP, to the topics of a vehicle. docs/build-a-vehicle.md leads from here to a first hover.
//
// The microcontroller measures and drives the motors; the control service flies. This process only carries messages between
// them. One thread owns the link; the one that receives commands hands it the newest:
//
//   microcontroller --frames--> run()         --imu, battery, rotor_speeds-->  control
//   microcontroller <--frames-- run() <--newest-- on_command() <--actuator_command--   control
//
// Both are on the way from sensor to motor: they allocate nothing, take no locks, and wait for nothing but poll(). All stamps
// are the microcontroller's clock. The command time-out is the microcontroller's too: whatever happens here, it stops the rotors.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/clocks/clock_server.hpp"
#include "swiftlet/services/dds/discovery/sole_source.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/hosting.hpp"
#include "swiftlet/services/runtime/latest_value.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/random_id.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"
#include "swiftlet/services/vehicle_template/link_reporter.hpp"
#include "swiftlet/services/vehicle_template/microcontroller_link.hpp"
#include "swiftlet/services/vehicle_template/wire.hpp"

namespace swiftlet::services {
namespace {

constexpr std::chrono::milliseconds kReportPeriod{20};

struct Options {
  std::string vehicle = "kaylion";
  ByteLinkSettings link;
  dds::NodeSettings node;
  runtime::ProcessOptions process;
};

class Vehicle final : public runtime::HostedVehicle {
 public:
  Vehicle(const dds::Participant& participant, const std::string& name, const plant::Vehicle& parameters,
          const ByteLinkSettings& link, const runtime::RealtimeSettings& realtime)
      : HostedVehicle(name),
        realtime_(realtime),
        link_(link),
        node_(participant, name, [this](const std::string& fault) { fail(fault); }),
        imu_(node_.publish(messages::topics::kImu)),
        rotor_speeds_(node_.publish(messages::topics::kRotorSpeeds)),
        battery_(node_.publish(messages::topics::kBattery)),
        reporter_(node_, parameters, link.name(), boot_),
        clock_server_(node_, [this] { return clock_ns(); }),
        commands_(node_.subscribe<messages::msg::ActuatorCommand>(
            messages::topics::kActuatorCommand, [this](const auto& message) { on_command(message); },
            dds::Delivery::kSamples)) {}

  // The thread of the link: everything that the microcontroller sends, and all that is sent to it.
  void run(const std::atomic<bool>& stop) override {
    if (realtime_.enabled) runtime::make_this_thread_realtime(realtime_);
    plant::ActuatorCommand command;
    while (!stop.load(std::memory_order_relaxed)) {
      link_.wait();
      while (const protocol::Frame* frame = link_.next()) publish(*frame);
      if (newest_command_.take(command)) link_.send(to_wire(command));
      hand_over();
    }
  }

  // The main thread, which may log and allocate.
  void attend() override {
    LinkMeasurements measurements;
    if (reports_.take(measurements)) reporter_.update(measurements);
    const std::string refusal = reporter_.fault_of_microcontroller();
    if (!refusal.empty()) return fail(refusal);
    reporter_.publish_due();
  }
  void log_end() override { reporter_.log_end(); }

 private:
  // The thread that receives commands hands over the newest one. The microcontroller refuses what it must not obey: an outdated
  // command, or one of a lower term.
  void on_command(const messages::msg::ActuatorCommand& message) {
    listener_.enter(realtime_);
    plant::ActuatorCommand command;
    if (messages::from_message(message, command)) return;  // a fault: not a number, or out of range
    newest_command_.put(command);
    link_.wake();
  }

  void publish(const protocol::Frame& frame) {
    if (const auto imu = protocol::message_of<protocol::Imu>(frame)) publish(*imu);
    if (const auto speeds = protocol::message_of<protocol::RotorSpeeds>(frame)) publish(*speeds);
    if (const auto battery = protocol::message_of<protocol::Battery>(frame)) publish(*battery);
    if (const auto state = protocol::message_of<protocol::State>(frame)) measurements_.note(*state);
  }

  // Each IMU sample is answered by one command, so it goes out before anything else is done.
  void publish(const protocol::Imu& sample) {
    messages::msg::Imu message = to_message(sample);
    message.obeyed().boot(boot_);
    message.sequence_number(++imu_samples_);
    imu_.publish(message);
    measurements_.note(sample, link_.clock_ns(link_.arrived_ns()));
  }
  void publish(const protocol::RotorSpeeds& sample) {
    messages::msg::RotorSpeeds message = to_message(sample);
    message.sequence_number(++rotor_speed_samples_);
    rotor_speeds_.publish(message);
  }
  void publish(const protocol::Battery& sample) {
    messages::msg::Battery message = to_message(sample);
    message.sequence_number(++battery_samples_);
    battery_.publish(message);
  }

  // To the other threads.
  void hand_over() {
    measurements_.link = link_.status();
    const bool connected = measurements_.link.state == LinkState::kConnected;
    clock_.put(connected ? measurements_.link.clock : std::nullopt);
    if (link_.arrived_ns() < report_due_ns_) return;
    report_due_ns_ = link_.arrived_ns() + std::chrono::nanoseconds(kReportPeriod).count();
    reports_.put(measurements_);
  }

  // The vehicle's clock now, for a motion capture with a clock of its own. In the thread that receives its requests.
  std::optional<std::int64_t> clock_ns() {
    clock_.take(served_clock_);
    if (!served_clock_) return std::nullopt;
    const std::int64_t now_ns = runtime::monotonic_ns();
    return now_ns + served_clock_->offset_at(now_ns);
  }

  const std::uint32_t boot_ = runtime::boot_number();
  const runtime::RealtimeSettings realtime_;
  runtime::RealtimeThread listener_;
  MicrocontrollerLink link_;
  LinkMeasurements measurements_;
  std::int64_t report_due_ns_ = 0;
  std::uint64_t imu_samples_ = 0;
  std::uint64_t rotor_speed_samples_ = 0;
  std::uint64_t battery_samples_ = 0;

  // From one thread to another, without waiting.
  runtime::LatestValue<plant::ActuatorCommand> newest_command_;
  runtime::LatestValue<LinkMeasurements> reports_;
  runtime::LatestValue<std::optional<clocks::ClockEstimate>> clock_;
  std::optional<clocks::ClockEstimate> served_clock_;

  dds::Node node_;
  dds::Publisher<messages::msg::Imu> imu_;
  dds::Publisher<messages::msg::RotorSpeeds> rotor_speeds_;
  dds::Publisher<messages::msg::Battery> battery_;
  LinkReporter reporter_;
  clocks::ClockServer clock_server_;  // last two: their callbacks use all members above
  dds::Subscription commands_;
};

void add_options(runtime::CommandLine app, Options& options) {
  auto device = app.add_option("--device", options.link.device, "Link: serial device of the microcontroller");
  app.add_option("--baud", options.link.baud, "Bits per second of the serial device; USB ignores it")
      .show_default()
      .needs(device);
  app.add_option("--udp", options.link.udp, "Link: UDP address of the microcontroller, HOST:PORT")
      .excludes(device);
  app.add_option("--vehicle", options.vehicle, "Vehicle file, or the name of one in config/vehicles")
      .show_default();
  options.node.name = "vehicle";
  dds::add_node_options(app, options.node);
  runtime::add_process_options(app, options.process);
}

void run(const Options& options) {
  const plant::Vehicle parameters =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  runtime::StopSignal stop;
  const runtime::Logging logging("vehicle", options.process.log);
  const runtime::RealtimeSettings realtime =
      runtime::prepare_realtime(options.process.realtime, runtime::Clock::kRealtime);

  dds::NodeSettings network = options.node;
  network.hears_of_all = false;
  network.announcement_period = messages::kFixturePeriod;
  network.realtime_priority = realtime.thread_priority();
  network.source_of = messages::topics::kImu.name;
  dds::Participant participant(network, {network.vehicle});
  const dds::SoleSource source(participant, network.source_of, [&stop] { stop.request(); });
  std::vector<std::unique_ptr<runtime::HostedVehicle>> vehicles;
  vehicles.push_back(
      std::make_unique<Vehicle>(participant, network.vehicle, parameters, options.link, realtime));
  dds::log_reach(network);
  runtime::log_info("ready: vehicle {} in domain {}, link {}", network.vehicle, network.domain,
                    options.link.name());
  runtime::host(std::move(vehicles), stop, kReportPeriod);
  source.check();
}

}  // namespace
}  // namespace swiftlet::services

int main(int argc, char** argv) {
  using namespace swiftlet;
  services::Options options;
  options.process.realtime.priority = 60;
  return runtime::run_process(
      {"swiftlet-vehicle-template",
       "Joins a vehicle's microcontroller to the network: publishes its samples, sends it the actuator "
       "commands. "
       "A template for a vehicle process of your own.",
       "--device /dev/ttyACM0 --baud 921600 --vehicle kaylion", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { services::add_options(app, options); },
      [&] { services::run(options); });
}
