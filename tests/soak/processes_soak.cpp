// Lets each process of a flight fail in each way at each level, and prints a row for each.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/soak/processes_flight.hpp"
#include "tests/soak/table_soak.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

// Returns true if it went as the table says.
bool fly_row(const ProcessCase& one) {
  const tests::TemporaryFolder folder;
  ProcessResult result;
  std::string fault;
  try {
    result = fly_with_failures({one}, folder.path()).front();
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

void print_header() {
  std::printf("%-38s %-10s %8s %9s  %s\n", "what fails", "vehicle", "climbs m", "leaves m",
              "reason of control's last mode");
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet::soak;
  const auto& rows = process_cases();
  return run_table_soak(
      {"processes_soak", "Kills, stops or restarts each process of a flight, at each level.",
       "--first 4 --last 7"},
      argc, argv, rows.size(), print_header, [&](std::size_t row) { return fly_row(rows[row]); });
}
