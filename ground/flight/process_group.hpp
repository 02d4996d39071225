// The processes of a simulated flight of one or several vehicles: plant, motion capture and control.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/child_process.hpp"

namespace swiftlet::ground {

class ProcessGroup {
 public:
  // Starts the processes in this order. If one cannot be started, ends the others and throws
  // std::runtime_error.
  explicit ProcessGroup(const std::vector<io::ProcessSettings>& processes);
  // Ends running processes: SIGTERM to all, SIGKILL to those that do not end within 10 s.
  ~ProcessGroup();
  ProcessGroup(const ProcessGroup&) = delete;
  ProcessGroup& operator=(const ProcessGroup&) = delete;

  // A sentence on the first process that has exited: its name, its exit status and its last log line. Thread-safe.
  std::optional<std::string> exited_process();

  // Ends all processes. Returns a sentence for each that did not end cleanly.
  std::vector<std::string> stop();

 private:
  std::mutex mutex_;  // guards children_
  std::vector<io::ChildProcess> children_;
};

}  // namespace swiftlet::ground
