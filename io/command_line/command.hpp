// A subcommand of `swiftlet`: add_X_command() adds its options to the command line and returns the function
// to run.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::io {

// Exit codes of the program.
constexpr int kDone = 0;      // the command succeeded
constexpr int kFailed = 1;    // the command ran and failed, or was refused
constexpr int kBadInput = 2;  // wrong usage or bad input; nothing was started and no request was sent

struct Command {
  runtime::CommandLine app;  // the subcommand; run is called if it was parsed
  // Returns kDone, kFailed or kBadInput. Throws InputError for bad input, another exception for a failure.
  std::function<int()> run;
};

// Runs the command that was given, one of the subcommands of a command that requires one; kBadInput if none was.
int run_given(const std::vector<Command>& commands);

// Bad input. what() is one sentence for the user.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace swiftlet::io
