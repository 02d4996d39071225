// Stability margins of a control design, on the nominal vehicle and on vehicles sampled from its uncertainty.
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
    control::LoopMargins designed;  // nominal vehicle
    control::LoopMargins most;      // held by 95 % of the samples, each margin by itself
    control::LoopMargins worst;     // worst of all samples, each margin by itself
  };
  std::array<Loop, kLoopNames.size()> loops;
  std::size_t samples = 0;  // number of samples; 0: only the nominal vehicle
  std::uint64_t seed = 0;
  std::size_t unstable = 0;  // samples with an unstable loop
};

// Computes the margins at the open-circuit voltage of a half-charged battery. With a dispersion, sample i has
// the seed `seed` + i. The model is linear about hover, without estimator, sampling and latency. Throws as
// draw() does.
MarginStudy study_margins(const control::ControlDesign& design, const plant::Vehicle& vehicle,
                          const simulation::Dispersion& dispersion, std::size_t samples, std::uint64_t seed);

}  // namespace swiftlet::ground
