// The processes of one simulated flight: plant, mocap and control.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/services/runtime/child_process.hpp"

namespace swiftlet::ground {

class ProcessGroup {
 public:
  // Starts them in this order. Throws std::runtime_error if one cannot be started; those before it are ended.
  explicit ProcessGroup(const std::vector<ProcessSettings>& processes);
  // Ends what still runs: SIGTERM to all, SIGKILL to those that do not end in time.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  // The first that has ended, as a sentence: who, how, and what it said last.
  std::optional<std::string> exited_process();

  // Ends all. Returns a sentence for each that did not end cleanly.
  std::vector<std::string> stop();

 private:
  std::vector<ChildProcess> children_;
};

}  // namespace swiftlet::ground
