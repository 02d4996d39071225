// Changes the addresses of a host of a vehicle, and prints a line for each change.
#include <cstddef>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/soak/address_change.hpp"
#include "tests/soak/table_soak.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::soak {
namespace {

bool change_row(const AddressChange& change) {
  const tests::TemporaryFolder folder;
  ChangeResult result = change_addresses(change, folder.path());
  if (result.fault.empty() && result.healed_s > kHealed_s) result.fault = "healed too late";
  std::printf("%-42s %8.2f  %s\n", change.name, result.healed_s,
              result.fault.empty() ? "" : ("FAILED " + result.fault + "\n" + result.log).c_str());
  std::fflush(stdout);
  return result.fault.empty();
}

}  // namespace
}  // namespace swiftlet::soak

int main(int argc, char** argv) {
  using namespace swiftlet::soak;
  const auto& rows = address_changes();
  return run_table_soak(
      {"networks_soak", "Changes the addresses of a host of a vehicle, network namespaces.",
       "--first 2 --last 3"},
      argc, argv, rows.size(), [] { std::printf("%-42s %8s\n", "change", "healed s"); },
      [&](std::size_t row) { return change_row(rows[row]); });
}
