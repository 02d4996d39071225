#include "swiftlet/ground/batch/margin_study.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "swiftlet/control/design/mismatch.hpp"
#include "swiftlet/plant/model/battery.hpp"

namespace swiftlet::ground {
namespace {

using control::LoopMargins;

constexpr double kHalfCharged = 0.5;
constexpr double kKept = 0.95;  // share of the samples

std::array<LoopMargins, kLoopNames.size()> margins_of(const control::ControlDesign& design,
                                                      const plant::Vehicle& designed,
                                                      const plant::Vehicle& flown) {
  const double voltage = plant::open_circuit_voltage(flown.battery, kHalfCharged);
  const control::LoopSet loops = control::loops_on(design, designed, flown, voltage);
  return {control::margins(loops.roll), control::margins(loops.pitch), control::margins(loops.yaw),
          control::margins(loops.x),    control::margins(loops.y),     control::margins(loops.z)};
}

// Returns the value that this share of `values` reaches or exceeds.
double kept_by(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>((1.0 - share) * static_cast<double>(values.size()))];
}

LoopMargins kept_by(const std::vector<LoopMargins>& all, double share) {
  const auto least = [&](double LoopMargins::*margin, double sign) {
    std::vector<double> values;
    values.reserve(all.size());
    for (const LoopMargins& one : all) values.push_back(sign * one.*margin);
    return sign * kept_by(std::move(values), share);
  };
  // gain_decrease is a factor below 1: a larger value is a smaller margin.
  return {least(&LoopMargins::phase_deg, 1.0), least(&LoopMargins::gain_increase, 1.0),
          least(&LoopMargins::gain_decrease, -1.0), least(&LoopMargins::delay_s, 1.0)};
}

}  // namespace

MarginStudy study_margins(const control::ControlDesign& design, const plant::Vehicle& vehicle,
                          const simulation::Dispersion& dispersion, std::size_t samples, std::uint64_t seed) {
  MarginStudy out;
  const auto designed = margins_of(design, vehicle, vehicle);
  std::array<std::vector<LoopMargins>, kLoopNames.size()> drawn;
  if (!dispersion.distributions.empty()) out.samples = samples;
  out.seed = seed;
  for (std::size_t i = 0; i < out.samples; ++i) {
    const auto margins = margins_of(design, vehicle, draw(dispersion, {vehicle, {}}, seed + i).world.vehicle);
    bool stable = true;
    for (std::size_t loop = 0; loop < margins.size(); ++loop) {
      drawn[loop].push_back(margins[loop]);
      stable = stable && margins[loop].delay_s > 0.0;
    }
    if (!stable) ++out.unstable;
  }
  for (std::size_t loop = 0; loop < designed.size(); ++loop) {
    out.loops[loop].designed = designed[loop];
    if (drawn[loop].empty()) continue;
    out.loops[loop].most = kept_by(drawn[loop], kKept);
    out.loops[loop].worst = kept_by(drawn[loop], 1.0);
  }
  return out;
}

}  // namespace swiftlet::ground
