// Numbers that tell processes apart.
#pragma once

#include <cstdint>
#include <random>

namespace swiftlet::runtime {

// From the entropy of the system: another one in each process and each call.
inline std::uint64_t random_id() {
  std::random_device device;
  return static_cast<std::uint64_t>(device()) << 32U | device();
}

// The `boot` of a vehicle that starts now; never 0.
inline std::uint32_t boot_number() { return static_cast<std::uint32_t>(random_id()) | 1U; }

}  // namespace swiftlet::runtime
