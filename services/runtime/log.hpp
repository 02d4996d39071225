// Logging of a process: spdlog's default logger, asynchronous. A caller never waits for the output; when the
// queue is full, the oldest line is dropped.
#pragma once

#include <string>

namespace swiftlet::runtime {

struct LogSettings {
  std::string level = "info";  // trace, debug, info, warning, error, off
  std::string file;            // written in addition to stderr; empty: none
};

// Lets the default logger write to stderr, for a program whose output is on stdout.
void log_to_stderr();

// Sets the default logger for its lifetime; the destructor writes the queued lines. One per process.
class Logging {
 public:
  // Throws std::runtime_error if the file cannot be written.
  Logging(const std::string& process, const LogSettings& settings);
  ~Logging();
  Logging(const Logging&) = delete;
  Logging& operator=(const Logging&) = delete;
};

}  // namespace swiftlet::runtime
