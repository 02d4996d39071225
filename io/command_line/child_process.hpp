// A child process of the launcher. It writes to its own log file, does not receive Ctrl-C from the launcher's
// terminal, and ends with the launcher, however that ends.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace swiftlet::io {

struct ProcessSettings {
  std::string name;  // for messages
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path log_file;                // standard output and error
  std::filesystem::path working_directory = {};  // empty: that of the launcher
};

// Returns the path of the program in $PATH; empty if there is none.
std::filesystem::path find_program(const std::string& name);

// How a process ended.
struct ProcessEnd {
  bool by_signal = false;
  int code = 0;  // the signal, or the exit status

  std::string to_string() const;  // "was killed by signal 9 (Killed)", "ended with exit status 1"
};

class ChildProcess {
 public:
  // Starts the program. Throws std::runtime_error with a sentence if that fails. The calling thread must live
  // as long as the child, because the kernel signals the child when that thread ends (PR_SET_PDEATHSIG).
  explicit ChildProcess(ProcessSettings settings);
  // Kills and reaps a running child.
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  const std::string& name() const { return settings_.name; }
  pid_t pid() const { return pid_; }

  // Returns how it ended; empty while it runs. Does not wait.
  std::optional<ProcessEnd> poll();
  // Waits for its end; empty after the timeout.
  std::optional<ProcessEnd> wait(std::chrono::milliseconds timeout);
  void signal(int number);  // no effect after its end

  // Sends SIGTERM, then SIGKILL if it still runs after `grace`, and waits for its end.
  ProcessEnd stop(std::chrono::milliseconds grace);

  std::string last_log_line() const;  // last non-blank line; empty if none

 private:
  ProcessSettings settings_;
  pid_t pid_ = -1;
  std::optional<ProcessEnd> end_;
};

}  // namespace swiftlet::io
