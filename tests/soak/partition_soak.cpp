// Cuts each link of a flight for each time, and prints a row for each.
#include <cstdio>
#include <exception>
#include <string>

#include "swiftlet/services/runtime/process.hpp"
#include "tests/soak/partition_flight.hpp"
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

int run(int first, int last) {
  std::printf("%-40s %-9s %9s %9s  %s\n", "cut", "vehicle", "control", "off cm", "reason of the last mode");
  const auto& all = partitions();
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
      {"partition_soak", "Cuts the network between two hosts of a flight, network namespaces.",
       "--first 4 --last 7"},
      argc, argv,
      [&](runtime::CommandLine app) {
        app.add_option("--first", first, "number of the first row").range(0, 1000).show_default();
        app.add_option("--last", last, "number of the last row").range(0, 1000);
      },
      [&] { exit_code = soak::run(first, last); });
  return status != 0 ? status : exit_code;
}
