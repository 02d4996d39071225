// swiftlet-ros: joins vehicles to ROS 2. docs/interoperability.md is its manual.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/ros/gateway.hpp"
#include "swiftlet/ground/ros/ros_graph.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/file/cdr_writer.hpp"
#include "swiftlet/services/dds/node_options.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"
#include "swiftlet/services/runtime/version.hpp"

namespace swiftlet::ros {
namespace {

struct Options {
  GatewaySettings gateway;
  std::size_t gid_bytes = kGidBytes;
  dds::NodeSettings node;
  runtime::LogSettings log;
};

void add_options(runtime::CommandLine app, Options& options) {
  app.add_choice(
         "--time", options.gateway.time, {{"wall", Time::kWall}, {"vehicle", Time::kVehicle}},
         "time in the headers of the messages: wall, the system clock, or vehicle, the stamps of the first "
         "vehicle, which are published as /clock: for lockstep")
      .show_default("wall");
  app.add_option("--goal-speed", options.gateway.goal_speed_m_s, "peak speed of flights to goals, m/s")
      .range(0.05, 5.0)
      .show_default();
  app.add_choice(
         "--ros-distro", options.gid_bytes,
         {{"humble", kGidBytesOfHumble},
          {"iron", kGidBytes},
          {"jazzy", kGidBytes},
          {"kilted", kGidBytes},
          {"rolling", kGidBytes}},
         "ROS 2 that is to see the nodes: humble numbers endpoints in another way than those after it")
      .show_default("jazzy");
  options.node.name = "ros";
  dds::add_service_options(app, options.node);
  runtime::add_log_options(app, options.log);
}

// Publishes /clock, which all vehicles share.
class ClockPublisher {
 public:
  ClockPublisher(const dds::Participant& participant, const std::string& vehicle)
      : node_(participant, vehicle), writer_(writer<Clock>(node_, "/clock")) {}

  void publish(std::int64_t time_ns) {
    record::CdrWriter out;
    out.put(static_cast<std::int32_t>(time_ns / math::kSecond_ns))
        .put(static_cast<std::uint32_t>(time_ns % math::kSecond_ns));
    writer_(out.take());
  }

 private:
  dds::Node node_;
  Writer writer_;
};

void run(const Options& options) {
  if (!options.node.security.empty())
    throw std::invalid_argument("--security: no role of DDS Security may use the topics of ROS 2");
  const std::vector<std::string> names = messages::vehicles_of_list(options.node.vehicle);
  runtime::StopSignal stop;
  const runtime::Logging logging("ros", options.log);
  const RosGraph graph(options.node, options.gid_bytes);
  const ground::Context context(options.node);
  std::optional<ClockPublisher> clock;
  if (options.gateway.time == Time::kVehicle) clock.emplace(context.participant(), names.front());
  std::vector<std::unique_ptr<Gateway>> gateways;
  for (const std::string& name : names) {
    std::function<void(std::int64_t)> keep_time;
    if (clock && name == names.front())
      keep_time = [&clock](std::int64_t time_ns) { clock->publish(time_ns); };
    gateways.push_back(std::make_unique<Gateway>(context, name, options.gateway, keep_time));
  }
  runtime::log_info("ready: vehicle {} in domain {}", fmt::join(names, ","), options.node.domain);
  stop.wait();
}

}  // namespace
}  // namespace swiftlet::ros

int main(int argc, char** argv) {
  using namespace swiftlet;
  ros::Options options;
  return runtime::run_process(
      {"swiftlet-ros",
       "Joins vehicles to ROS 2: publishes what they say as standard types, shows the processes as nodes, "
       "and flies to "
       "goals and by velocities that programs of ROS 2 send.",
       "--vehicle-name kl1,kl2 --ros-distro jazzy", runtime::version_text()},
      argc, argv, [&](runtime::CommandLine app) { ros::add_options(app, options); },
      [&] { ros::run(options); });
}
