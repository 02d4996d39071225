// How a subcommand joins the program `swiftlet`: add_X_command adds its options to the command line and hands
// back what to run.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// What the program returns.
constexpr int kDone = 0;      // it did what was asked
constexpr int kFailed = 1;    // it ran and failed
constexpr int kBadInput = 2;  // wrong usage or bad input; nothing was started or moved

struct Command {
  runtime::CommandLine app;  // the subcommand; run is called if it was parsed
  std::function<int()>
      run;  // returns kDone, kFailed or kBadInput, or throws: InputError is bad input, any other a failure
};

// Input that was refused. what() is one sentence for the user.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace swiftlet::ground
