#include <array>
#include <optional>

#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : AskOptions {
  std::array<double, 3> position_ned{};
  std::optional<double> yaw_rad;
  double speed = 0.5;
};

}  // namespace

Command add_goto_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_ask_subcommand(
      root, "goto", "Fly straight to a place, north, east and down of the origin, and hold there",
      "swiftlet goto -1 0 -1.5 --yaw 1.57    (1 m south of the origin, 1.5 m up, nose to the east)", options,
      Vehicles::kOne);  // a place has room for one
  constexpr const char* kNames[] = {"x", "y", "z"};
  constexpr const char* kMeanings[] = {"north, m", "east, m", "down, m: negative is up"};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    app.add_option(kNames[axis], options->position_ned[axis], kMeanings[axis]).required().finite();
  }
  app.add_option("--yaw", options->yaw_rad,
                 "heading to be reached with the place, rad from north to the east; kept unless given")
      .finite();
  app.add_option("--speed", options->speed, "peak speed, m/s").positive().show_default();
  return {app, [options] {
            return run_request(*options, "goto", [&](Vehicle& vehicle) {
              const auto& [x, y, z] = options->position_ned;
              return vehicle.go_to({{x, y, z}, options->yaw_rad, options->speed}, options->timeout());
            });
          }};
}

}  // namespace swiftlet::ground
