#include "swiftlet/ground/flight/process_group.hpp"

#include <csignal>

namespace swiftlet::ground {
namespace {

// A busy machine, or its disk, may delay a process by many seconds.
constexpr std::chrono::seconds kGrace{30};

}  // namespace

ProcessGroup::ProcessGroup(const std::vector<io::ProcessSettings>& processes) {
  children_.reserve(processes.size());
  for (const io::ProcessSettings& process : processes) children_.emplace_back(process);
}

ProcessGroup::~ProcessGroup() { stop(); }

std::optional<std::string> ProcessGroup::exited_process() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (io::ChildProcess& child : children_) {
    const auto end = child.poll();
    if (!end) continue;
    const std::string last_line = child.last_log_line();
    return child.name() + " " + end->to_string() + (last_line.empty() ? "" : "; last log line: " + last_line);
  }
  return std::nullopt;
}

std::vector<std::string> ProcessGroup::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> errors;
  for (io::ChildProcess& child : children_) child.signal(SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + kGrace;
  for (io::ChildProcess& child : children_) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    const bool ended = child.wait(left).has_value();
    const io::ProcessEnd end = child.stop(std::chrono::milliseconds::zero());
    if (!ended) {
      errors.push_back(child.name() + " did not end within " + std::to_string(kGrace.count()) +
                       " s of SIGTERM and was killed");
    } else if (end.by_signal || end.code != 0) {
      errors.push_back(child.name() + " " + end.to_string());
    }
  }
  children_.clear();
  return errors;
}

}  // namespace swiftlet::ground
