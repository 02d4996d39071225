// Cuts each link of a flight for each time, and prints a row for each.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/soak/partition_flight.hpp"
#include "tests/soak/table_soak.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

// Returns true if it went as the table says.
bool fly_row(const Partition& partition) {
  const tests::TemporaryFolder folder;
  PartitionResult result;
  std::string fault;
  try {
    result = fly_through(partition, folder.path());
  } catch (const std::exception& error) {
    fault = error.what();
  }
  if (fault.empty() && result.outcome != partition.expected)
    fault = std::string("expected: ") + to_string(partition.expected);
  if (fault.empty() && !result.healed) fault = "some do not hear each other again";
  if (fault.empty() && !result.had_priority) fault = "the real-time priority was not granted";
  if (fault.empty() && !result.priority_kept) fault = "the real-time priority was lost";
  std::printf("%-40s %-9s %9s %9.1f  %-60s %s\n", partition.name().c_str(),
              result.outcome ? to_string(*result.outcome) : "-",
              result.standby_took_over ? "standby" : "same", 100.0 * result.deviation_m,
              result.reason.c_str(), fault.empty() ? "" : ("FAILED " + fault).c_str());
  std::fflush(stdout);
  return fault.empty();
}

void print_header() {
  std::printf("%-40s %-9s %9s %9s  %s\n", "cut", "vehicle", "control", "off cm", "reason of the last mode");
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet::soak;
  const auto& rows = partitions();
  return run_table_soak(
      {"partition_soak", "Cuts the network between two hosts of a flight, network namespaces.",
       "--first 4 --last 7"},
      argc, argv, rows.size(), print_header, [&](std::size_t row) { return fly_row(rows[row]); });
}
