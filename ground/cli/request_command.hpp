// Common parts of the commands that send a request to a running vehicle.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "swiftlet/ground/cli/await_actions.hpp"
#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Options of every command that talks to running vehicles.
struct CommandOptions {
  dds::NodeSettings network;
  double timeout_s = 5.0;  // longest wait for the acknowledgement
  bool json = false;

  std::chrono::milliseconds timeout() const {
    return std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1e3));
  }
};

// Options of a command that sends one request.
struct RequestOptions : CommandOptions {
  bool no_wait = false;          // return as soon as the request is answered
  std::optional<double> wait_s;  // longest wait for completion; unset: no limit
};

struct VehicleRequest {
  std::string what;  // "takeoff": begins each line of output
  std::function<ActionHandle(Vehicle&)> ask;
  OnInterrupt on_interrupt = OnInterrupt::kHold;
  bool done_when_accepted = false;  // the action ends as soon as the request is accepted
  // If set, the request is sent to all vehicles or to none: it is not sent if one of them is not found. If one
  // refuses it, `undo` is sent to the others that were in this mode before. The texts say what became of them, and why.
  std::function<ActionHandle(Vehicle&)> undo{};
  control::Mode undo_from = control::Mode::kDisarmed;
  // With `undo`: it is also taken back if the last one accepted it later than this after it was sent to all.
  std::optional<double> skew_s{};
  std::string undone = "disarmed again", not_undone = "still armed", cause = "did not arm";
};

// Adds a subcommand with the network options, --timeout and --json. The command's run function must keep `options`
// alive.
runtime::CommandLine add_vehicle_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<CommandOptions>& options,
                                            Vehicles vehicles = Vehicles::kOne);

// As add_vehicle_subcommand(), with --wait and --no-wait in addition, and for several vehicles by default.
runtime::CommandLine add_request_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<RequestOptions>& options,
                                            Vehicles vehicles = Vehicles::kSeveral);

// Joins the network, sends the request to all vehicles at once, each from its own thread, and waits until the
// action of each vehicle ends. Prints the answers and results. The JSON output is the result of the vehicle,
// or with several vehicles an object with their names as keys. Returns the exit code: kFailed if a vehicle
// failed or the wait was interrupted.
int run_request(const RequestOptions& options, const VehicleRequest& request);

// Prints a line to standard error, prefixed with `command`, whenever the connection to the vehicle's control
// process is lost, is restored or changes to another process.
void log_connection(Vehicle& vehicle, const std::string& command);

// A request without arguments.
struct PlainRequest {
  const char* name;
  const char* description;
  ActionHandle (Vehicle::*ask)(std::chrono::milliseconds);
  OnInterrupt on_interrupt = OnInterrupt::kNothing;
  bool done_when_accepted = false;
  ActionHandle (Vehicle::*undo)(std::chrono::milliseconds) = nullptr;  // see VehicleRequest
};
io::Command add_plain_request_command(runtime::CommandLine root, const PlainRequest& request);

}  // namespace swiftlet::ground
