#include "swiftlet/services/runtime/process.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <unistd.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::runtime {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

int fail(const ProgramText& text, const std::exception& error, int code) {
  std::fprintf(stderr, "%s: %s\n", text.name, error.what());
  return code;
}

int run_reporting_errors(const ProgramText& text, int argc, char** argv,
                         const std::function<void(CommandLine)>& add_options,
                         const std::function<void()>& body) {
  try {
    Program program(text.name, text.purpose);
    if (text.version != nullptr) program.add_version(text.version);
    const CommandLine app = program.command_line();
    app.footer(std::string("Example: ") + text.name + ' ' + text.example);
    add_options(app);
    const Program::Parsed parsed = program.parse(argc, argv);
    if (parsed != Program::Parsed::kRun) return parsed == Program::Parsed::kHelp ? 0 : kBadInput;
    limit_thread_stacks();
    body();
    return 0;
  } catch (const io::ConfigError& error) {
    return fail(text, error, kBadInput);
  } catch (const std::invalid_argument& error) {
    return fail(text, error, kBadInput);
  } catch (const std::exception& error) {
    return fail(text, error, kFailed);
  }
}

// 0 if all of standard output was written. The error of an earlier write is no longer known: a line end, which
// fails likewise, shows it.
int output_error() {
  if (std::fflush(stdout) != 0) return errno;
  if (std::ferror(stdout) == 0) return 0;
  return ::write(STDOUT_FILENO, "\n", 1) < 0 ? errno : EIO;
}

}  // namespace

void add_log_options(CommandLine app, LogSettings& log) {
  app.add_option("--log-level", log.level, "Lowest severity to log")
      .one_of({"trace", "debug", "info", "warning", "error", "off"})
      .show_default();
  app.add_option("--log-file", log.file, "Log to this file as well as to stderr");
}

void add_process_options(CommandLine app, ProcessOptions& options) {
  add_log_options(app, options.log);
  app.add_flag("!--no-realtime", options.realtime.enabled, "Do not lock memory or request SCHED_FIFO");
  app.add_option("--priority", options.realtime.priority, "SCHED_FIFO priority of the real-time thread")
      .range(1, 99)
      .show_default();
  app.add_option("--cpu", options.realtime.cpu, "CPU core of the real-time thread; -1: any")
      .range(-1, 1023)
      .show_default();
}

RealtimeSettings prepare_realtime(RealtimeSettings settings, Clock clock) {
  settings.enabled = settings.enabled && clock == Clock::kRealtime;
  if (!settings.enabled) return settings;
  std::string refusals = lock_memory();
  std::thread([&] {
    const std::string refusal = make_this_thread_realtime(settings);
    if (!refusals.empty() && !refusal.empty()) refusals += "; ";
    refusals += refusal;
  }).join();
  if (!refusals.empty())
    runtime::log_warning("real-time setup is incomplete, steps may be late: {}", refusals);
  return settings;
}

int exit_code_after_output(const char* program, int exit_code) {
  const int error = output_error();
  if (error == 0 || exit_code != 0) return exit_code;
  std::fprintf(stderr, "%s: cannot write to standard output: %s\n", program, std::strerror(error));
  return kFailed;
}

int run_process(const ProgramText& text, int argc, char** argv,
                const std::function<void(CommandLine)>& add_options, const std::function<void()>& body) {
  return exit_code_after_output(text.name, run_reporting_errors(text, argc, argv, add_options, body));
}

}  // namespace swiftlet::runtime
