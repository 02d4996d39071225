#include "swiftlet/control/design/flown_delay.hpp"

#include <algorithm>
#include <limits>

namespace swiftlet::control {
namespace {

constexpr double kStep_s = 1e-3;
constexpr double kAccuracy_s = 1e-5;

bool is_stable(const Loop& loop) {
  const auto poles = closed_loop_poles(loop);
  return std::all_of(poles.begin(), poles.end(), [](const auto& pole) { return pole.real() < 0.0; });
}

}  // namespace

std::array<double, 6> flown_delay_margins(const ControlDesign& design, const ControlSettings& settings) {
  return delay_margins([&](double delay_s) { return flown_loops(design, settings, delay_s); });
}

std::array<double, 6> delay_margins(const LoopsAtDelay& loops_at) {
  const auto stable = [&](double delay_s) {
    const std::array<FlownLoop, 6> loops = loops_at(delay_s);
    std::array<bool, 6> all{};
    std::transform(loops.begin(), loops.end(), all.begin(),
                   [](const FlownLoop& flown) { return is_stable(flown.loop); });
    return all;
  };
  std::array<double, 6> margins;
  margins.fill(std::numeric_limits<double>::infinity());
  const std::array<bool, 6> without = stable(0.0);
  for (std::size_t i = 0; i < margins.size(); ++i) {
    if (!without[i]) margins[i] = 0.0;
  }
  for (double delay_s = kStep_s; delay_s <= kLongestDelay_s; delay_s += kStep_s) {
    const std::array<bool, 6> with = stable(delay_s);
    for (std::size_t i = 0; i < margins.size(); ++i) {
      if (with[i] || margins[i] < delay_s) continue;
      double below_s = delay_s - kStep_s;
      double above_s = delay_s;
      while (above_s - below_s > kAccuracy_s) {
        const double middle_s = 0.5 * (below_s + above_s);
        (stable(middle_s)[i] ? below_s : above_s) = middle_s;
      }
      margins[i] = above_s;
    }
  }
  return margins;
}

double least_flown_delay_margin(const ControlGains& gains, const ObservedRotors& rotors) {
  return least_delay_margin([&](double delay_s) { return flown_loops(gains, rotors, delay_s); });
}

double least_delay_margin(const LoopsAtDelay& loops_at) {
  for (double delay_s = 0.0; delay_s <= kLongestDelay_s; delay_s += kLeastDelayAccuracy_s) {
    const std::array<FlownLoop, 6> loops = loops_at(delay_s);
    const bool stable =
        std::all_of(loops.begin(), loops.end(), [](const FlownLoop& flown) { return is_stable(flown.loop); });
    if (!stable) return std::max(0.0, delay_s - kLeastDelayAccuracy_s);
  }
  return kLongestDelay_s;
}

}  // namespace swiftlet::control
