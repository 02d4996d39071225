#include "swiftlet/io/command_line/run_command_line.hpp"

#include <cstdio>
#include <exception>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"

namespace swiftlet::io {
namespace {

int report_error(const std::exception& error, int code) {
  std::fprintf(stderr, "swiftlet: %s\n", error.what());
  return code;
}

}  // namespace

int run_given(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (command.app.parsed()) return command.run();
  }
  return kBadInput;
}

int run_reporting_errors(const std::function<int()>& run) {
  try {
    return run();
  } catch (const InputError& error) {
    return report_error(error, kBadInput);
  } catch (const io::ConfigError& error) {
    return report_error(error, kBadInput);
  } catch (const std::exception& error) {
    return report_error(error, kFailed);
  }
}

int run_command_line(runtime::Program& program, int argc, char** argv, const std::function<int()>& run) {
  using Parsed = runtime::Program::Parsed;
  runtime::log_to_stderr("swiftlet");
  const int exit_code = run_reporting_errors([&] {
    const Parsed parsed = program.parse(argc, argv);
    return parsed == Parsed::kRun ? run() : parsed == Parsed::kHelp ? kDone : kBadInput;
  });
  return runtime::exit_code_after_output("swiftlet", exit_code);
}

}  // namespace swiftlet::io
