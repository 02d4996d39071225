// A flight of a mission while changed copies of its datagrams are sent to all of its processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/datagram_attack.hpp"

namespace swiftlet::soak {

struct HostileSettings {
  std::uint64_t datagrams = 1'000'000;
  int per_second = 10'000;
  double baseline_s = 3.0;  // of the vehicle's time, before the attack
  std::uint64_t seed = 1;
  bool network_key = false;  // the flight has a network key, the attack has it not
  bool forges = false;       // the attack also speaks for participants of the flight
};

struct HostileResult {
  std::uint64_t sent = 0;
  double attacked_s = 0.0;
  double memory_growth_mib = 0.0;  // of the process that grew most, in the second half of the attack
  std::vector<std::string> dead;   // processes that ended

  // With a network key only: without it nobody can tell a changed sample from a true one, and the vehicle may stop or land.
  double late_before = 0.0;  // part of the IMU samples that were answered later than one period
  double late_during = 0.0;
  double largest_deviation_m = 0.0;  // of true position from reference during the attack
  bool mission_completed = false;
};

// Plant, motion capture and two controllers in a network of their own; the ground client is in this process. Needs root.
// Files of the processes are in `folder`. Throws std::runtime_error with a sentence, also if the ground hears vehicle or
// control no more after the attack.
HostileResult fly_under_attack(const HostileSettings& settings, const std::filesystem::path& folder);

}  // namespace swiftlet::soak
