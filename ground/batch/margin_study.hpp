// The margins of a design, on the vehicle that it is made for and on those that may fly in its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::ground {

inline constexpr std::array<const char*, 6> kLoopNames = {"roll", "pitch", "yaw", "x", "y", "z"};

struct MarginStudy {
  struct Loop {
    control::LoopMargins designed;  // on the vehicle of the design
    control::LoopMargins most;      // that 95 % of the draws keep, each margin by itself
    control::LoopMargins worst;     // of all draws, likewise
  };
  std::array<Loop, kLoopNames.size()> loops;
  std::size_t draws = 0;  // 0: only the design's own
  std::uint64_t seed = 0;
  std::size_t unstable = 0;  // draws of which a loop is not stable
};

// At the voltage of a half-charged battery without load. With a variation, draw i has the seed `seed` + i.
// Linear about hover; estimator, sampling and latency are left out. Throws as draw().
MarginStudy study_margins(const control::ControlDesign& design, const plant::Vehicle& vehicle,
                          const Dispersion& dispersion, std::size_t draws, std::uint64_t seed);

}  // namespace swiftlet::ground
