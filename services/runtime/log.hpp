// Logging of a process: spdlog's default logger, asynchronous. A caller never waits for the output; when the
// queue is full, the oldest line is dropped.
//
// Lines are formatted in one place: with spdlog's own functions, which are templates, every file that logs takes the compiler three
// seconds more.
#pragma once

#include <string>

#include <fmt/core.h>

namespace swiftlet::runtime {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

void write_log(LogLevel level, fmt::string_view format, fmt::format_args arguments);

template <typename... Arguments>
void log_debug(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_log(LogLevel::kDebug, format, fmt::make_format_args(arguments...));
}
template <typename... Arguments>
void log_info(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_log(LogLevel::kInfo, format, fmt::make_format_args(arguments...));
}
template <typename... Arguments>
void log_warning(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_log(LogLevel::kWarning, format, fmt::make_format_args(arguments...));
}
template <typename... Arguments>
void log_error(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_log(LogLevel::kError, format, fmt::make_format_args(arguments...));
}

struct LogSettings {
  std::string level = "info";  // trace, debug, info, warning, error, off
  std::string file;            // written in addition to stderr; empty: none
};

// Lets the default logger write to stderr, for a program whose output is on stdout.
void log_to_stderr(const std::string& program);

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
