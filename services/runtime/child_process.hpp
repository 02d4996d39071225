// A program that the launcher starts beside itself and answers for: it writes to a log file of its own, hears
// no Ctrl-C of the launcher's terminal, and ends with the launcher, however that ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace swiftlet::ground {

struct ProcessSettings {
  std::string name;  // for messages
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path log_file;                // standard output and error
  std::filesystem::path working_directory = {};  // empty: the launcher's
};

// The program of this name in $PATH; empty if there is none.
std::filesystem::path find_program(const std::string& name);

// How a process ended.
struct ProcessEnd {
  bool by_signal = false;
  int code = 0;  // the signal, or the exit status

  std::string to_string() const;  // "was killed by signal 9 (Killed)", "ended with exit status 1"
};

class ChildProcess {
 public:
  // Throws std::runtime_error with a sentence if the program cannot be started. The thread that calls it must
  // live as long as the child: the kernel takes that thread's end for the launcher's.
  explicit ChildProcess(ProcessSettings settings);
  // Kills and reaps a child that still runs.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  const std::string& name() const { return settings_.name; }
  pid_t pid() const { return pid_; }

  // Empty while it runs. Does not wait.
  std::optional<ProcessEnd> poll();
  // Empty if it runs for longer than this.
  std::optional<ProcessEnd> wait(std::chrono::milliseconds timeout);
  void signal(int number);  // to a child that still runs

  // SIGTERM, then SIGKILL to what still runs after `grace`.
  ProcessEnd stop(std::chrono::milliseconds grace);

  std::string last_log_line() const;  // empty if it has said nothing

 private:
  ProcessSettings settings_;
  pid_t pid_ = -1;
  std::optional<ProcessEnd> end_;
};

}  // namespace swiftlet::ground
