#include "swiftlet/ground/command_line/run_command_line.hpp"

#include <cstdio>
#include <exception>

#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/process.hpp"

namespace swiftlet::ground {
namespace {

int report_error(const std::exception& error, int code) {
  std::fprintf(stderr, "swiftlet: %s\n", error.what());
  return code;
}

int run_reporting_errors(runtime::Program& program, int argc, char** argv, const std::function<int()>& run) {
  using Parsed = runtime::Program::Parsed;
  try {
    const Parsed parsed = program.parse(argc, argv);
    return parsed == Parsed::kRun ? run() : parsed == Parsed::kHelp ? kDone : kBadInput;
  } catch (const InputError& error) {
    return report_error(error, kBadInput);
  } catch (const runtime::ConfigError& error) {
    return report_error(error, kBadInput);
  } catch (const std::exception& error) {
    return report_error(error, kFailed);
  }
}

}  // namespace

int run_command_line(runtime::Program& program, int argc, char** argv, const std::function<int()>& run) {
  runtime::log_to_stderr();
  return runtime::exit_code_after_output("swiftlet", run_reporting_errors(program, argc, argv, run));
}

}  // namespace swiftlet::ground
