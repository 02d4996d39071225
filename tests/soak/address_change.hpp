// A host whose addresses change while the processes of a vehicle run. Needs root.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace swiftlet::soak {

// Plant and motion capture are on host 0, control on host 0 or 1, and the ground on the host of control.
struct AddressChange {
  struct Command {
    int host;          // or HostNetwork::kCentre
    const char* text;  // of the shell; $vehicle is the namespace of host 0
  };
  const char* name;
  int control;                  // its host
  std::vector<Command> before;  // anything starts
  std::vector<Command> change;
  const char* says;    // what a process logs then
  bool flies = false;  // the vehicle hovers meanwhile
};
// The rows of the table in docs/several-hosts.md.
const std::vector<AddressChange>& address_changes();

struct ChangeResult {
  // Until a tool, started with the change, has armed the vehicle, or read the state of one that flies. With its start, 0.2 s.
  double healed_s = 0.0;
  std::string fault;  // what did not go as it has to, a sentence; empty: nothing
  std::string log;    // of all programs
};

// Within this time each change heals.
constexpr double kHealed_s = 3.0;

// Then lands the vehicle, and stops the rotors, by a tool of the vehicle's own host. Programs write their output into the folder.
ChangeResult change_addresses(const AddressChange& change, const std::filesystem::path& folder);

}  // namespace swiftlet::soak
