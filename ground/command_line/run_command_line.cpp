#include "swiftlet/ground/command_line/run_command_line.hpp"

#include <cstdio>
#include <exception>

#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::ground {
namespace {

int complain(const std::exception& error, int code) {
  std::fprintf(stderr, "swiftlet: %s\n", error.what());
  return code;
}

}  // namespace

int run_command_line(runtime::Program& program, int argc, char** argv, const std::function<int()>& run) {
  using Parsed = runtime::Program::Parsed;
  try {
    const Parsed parsed = program.parse(argc, argv);
    return parsed == Parsed::kRun ? run() : parsed == Parsed::kHelp ? kDone : kBadInput;
  } catch (const InputError& error) {
    return complain(error, kBadInput);
  } catch (const runtime::ConfigError& error) {
    return complain(error, kBadInput);
  } catch (const std::exception& error) {
    return complain(error, kFailed);
  }
}

}  // namespace swiftlet::ground
