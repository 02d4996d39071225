// What the commands that ask one thing of a running vehicle have in common.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "ground/client.hpp"
#include "ground/command.hpp"
#include "services/comms/node.hpp"

namespace swiftlet::ground {

struct RequestOptions {
  comms::NodeSettings network;
  double timeout_s = 5.0;  // for an answer
  bool json = false;
};

// A subcommand with the network's options, --timeout and --json; `options` is kept by what run captures.
CLI::App* add_request_subcommand(CLI::App& root, const std::string& name, const std::string& description,
                                 const std::string& example, const std::shared_ptr<RequestOptions>& options);

// Joins the network, asks, prints the answer. Returns the exit code.
int run_request(const RequestOptions& options, const std::string& what,
                const std::function<Answer(Client&)>& ask);

// A subcommand that sends a Command without arguments.
Command add_plain_request_command(CLI::App& root, const std::string& name, const std::string& description,
                                  std::uint8_t kind);

std::chrono::milliseconds milliseconds(double seconds);

}  // namespace swiftlet::ground
