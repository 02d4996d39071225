// Cuts each link of a flight for each time, and prints a line for each cut.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/soak/partition_flight.hpp"
#include "tests/soak/table_soak.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

// Returns true if all cuts went as the table says.
bool fly_row(const Partition& partition) {
  const tests::TemporaryFolder folder;
  bool good = true;
  const auto print = [&](const Partition&, const Cut& cut, const CutResult& result) {
    const std::string fault = fault_of(partition, cut, result);
    good = good && fault.empty();
    std::printf("%-34s %5d %-9s %9s %9.0f %9.0f %8.1f %9.2f  %-44s %s\n", partition.name().c_str(), cut.ms,
                result.outcome ? to_string(*result.outcome) : "-",
                result.standby_took_over ? "standby" : "same", result.metrics.longest_gap_ms,
                result.core_stood_still_ms, 100.0 * result.metrics.largest_deviation_m,
                result.metrics.final_distance_m, result.reasons.c_str(),
                fault.empty() ? "" : (" FAILED " + fault).c_str());
    if (!fault.empty()) std::printf("%s", result.log.c_str());
    std::fflush(stdout);
  };
  try {
    fly_through({partition}, folder.path(), print);
  } catch (const std::exception& error) {
    std::printf("%-34s FAILED %s\n", partition.name().c_str(), error.what());
    return false;
  }
  return good;
}

void print_header() {
  std::printf("%-34s %5s %-9s %9s %9s %9s %8s %9s  %s\n", "cut", "ms", "vehicle", "control", "gap ms",
              "still ms", "off cm", "moved m", "reasons of the modes since");
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet::soak;
  const auto& rows = partitions();
  return run_table_soak(
      {"partition_soak", "Cuts the network between two hosts of a flight, network namespaces.",
       "--first 2 --last 3"},
      argc, argv, rows.size(), print_header, [&](std::size_t row) { return fly_row(rows[row]); });
}
