#include <utility>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/ground/cli/sent_mission.hpp"

namespace swiftlet::ground {
namespace {

struct TrajectoryOptions : RequestOptions {
  SentFileOptions sent;
};

int send_trajectory(const TrajectoryOptions& options) {
  const SentFile sent(options.sent, options.network, options.timeout());
  const io::TrajectoryFile file = sent.trajectory();
  const control::Trajectory trajectory{0, file.segments};
  return run_request(options, {"trajectory", [&](Vehicle& vehicle) {
                                 sent.require_flyable(vehicle, file, options.timeout());
                                 return vehicle.follow(trajectory, options.timeout());
                               }});
}

}  // namespace

io::Command add_trajectory_command(runtime::CommandLine root) {
  const auto options = std::make_shared<TrajectoryOptions>();
  const runtime::CommandLine app = add_request_subcommand(
      root, "trajectory", "Fly a trajectory of a CSV file; the vehicle joins it from its motion",
      "swiftlet trajectory config/missions/wave.csv", options, Vehicles::kOne);
  add_sent_file_options(app, options->sent,
                        "trajectory or waypoints as CSV, or the name of such in config/missions");
  return {app, [options] { return send_trajectory(*options); }};
}

}  // namespace swiftlet::ground
