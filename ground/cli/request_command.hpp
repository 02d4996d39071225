// What the commands that ask one thing of a running vehicle have in common.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/ground/command_line/network_options.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

struct RequestOptions {
  comms::NodeSettings network;
  double timeout_s = 5.0;  // for an answer
  bool json = false;

  std::chrono::milliseconds timeout() const {
    return std::chrono::milliseconds(static_cast<std::int64_t>(timeout_s * 1e3));
  }
};

// Of a command that asks one thing.
struct AskOptions : RequestOptions {
  std::optional<double> wait_s;  // until it is done, at most so long
};

// A subcommand with the network's options, --timeout and --json; `options` is kept by what run captures.
runtime::CommandLine add_request_subcommand(runtime::CommandLine root, const std::string& name,
                                            const std::string& description, const std::string& example,
                                            const std::shared_ptr<RequestOptions>& options);

// Likewise, with --wait, and for several vehicles unless told.
runtime::CommandLine add_ask_subcommand(runtime::CommandLine root, const std::string& name,
                                        const std::string& description, const std::string& example,
                                        const std::shared_ptr<AskOptions>& options,
                                        Vehicles vehicles = Vehicles::kSeveral);

// Joins the network, asks all vehicles at once, each in a thread of its own, prints the answers, and waits
// for the end where that was wanted. As JSON the answer of one vehicle, or an object of those of several by
// name. Returns the exit code: a failure if one of them failed.
int run_request(const AskOptions& options, const std::string& what,
                const std::function<ActionHandle(Vehicle&)>& ask);

// From now on says on standard error, in the command's name, when the vehicle's control process falls silent, is heard
// again, or is another one.
void log_connection(Vehicle& vehicle, const std::string& command);

// A subcommand that asks for something without arguments.
Command add_plain_request_command(runtime::CommandLine root, const std::string& name,
                                  const std::string& description,
                                  ActionHandle (Vehicle::*ask)(std::chrono::milliseconds));

}  // namespace swiftlet::ground
