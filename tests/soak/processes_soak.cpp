// Lets each process of a flight fail in each way at each level, and prints a row for each.
#include <cstdio>
#include <exception>
#include <string>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/processes_flight.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

// Returns true if it went as the table says.
bool fly_row(const ProcessCase& one) {
  const tests::TemporaryFolder folder;
  ProcessResult result;
  std::string fault;
  try {
    result = fly_with_failure(one, folder.path());
  } catch (const std::exception& error) {
    fault = error.what();
  }
  if (fault.empty() && result.fate != one.expected)
    fault = std::string("expected: ") + to_string(one.expected);
  if (fault.empty() && result.climb_m > kMostClimb_m) fault = "it climbed";
  std::printf("%-38s %-10s %8.2f %9.2f  %-40s %s\n", one.name().c_str(),
              result.fate ? to_string(*result.fate) : "-", result.climb_m, result.sideways_m,
              result.reason.c_str(), fault.empty() ? "" : ("FAILED " + fault).c_str());
  std::fflush(stdout);
  return fault.empty();
}

int run(int first, int last) {
  std::printf("%-38s %-10s %8s %9s  %s\n", "what fails", "vehicle", "climbs m", "leaves m",
              "reason of control's last mode");
  const auto& all = process_cases();
  int bad = 0;
  for (int row = first; row <= last && row < static_cast<int>(all.size()); ++row)
    bad += fly_row(all[static_cast<std::size_t>(row)]) ? 0 : 1;
  return bad == 0 ? 0 : 1;
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet;
  int first = 0;
  int last = 1000;
  int exit_code = 0;
  const int status = runtime::run_process(
      {"processes_soak", "Kills, stops or restarts each process of a flight, at each level.",
       "--first 4 --last 7"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--first", first, "number of the first row").range(0, 1000).show_default();
        app.add_option("--last", last, "number of the last row").range(0, 1000);
      },
      [&] { exit_code = soak::run(first, last); });
  return status != 0 ? status : exit_code;
}
