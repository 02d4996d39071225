#include "swiftlet/analysis/tuning/tuning_study.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace swiftlet::analysis {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kStepPoints = 600;
constexpr std::size_t kBodePoints = 240;
// The ranges of the curves, relative to the crossover of the slowest settings: time in 1 / omega, frequency
// from 1 / kBodeRange to kBodeRange.
constexpr double kStepRange = 16.0;
constexpr double kBodeRange = 30.0;
constexpr std::size_t kLongPoints = 8 * kStepPoints;  // for the figures: an integral settles slowly
constexpr double kDiverged = 2.5;
constexpr double kSettled = 0.05;

// The crossover with the least phase margin; NaN without a crossover.
double decisive_crossover(const control::Loop& loop) {
  double found = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const double omega : control::crossovers(loop)) {
    const double margin = std::abs(std::arg(-control::frequency_response(loop, omega)));
    if (margin < least) found = omega;
    least = std::min(least, margin);
  }
  return found;
}

double time_of(const std::vector<double>& response, double step_s, double level) {
  const auto at = std::find_if(response.begin(), response.end(), [level](double y) { return y >= level; });
  return at == response.end() ? kNone : step_s * static_cast<double>(at - response.begin());
}

StepFigures figures_of(const std::vector<double>& response, double step_s) {
  StepFigures out;
  out.rise_time_s = time_of(response, step_s, 0.9) - time_of(response, step_s, 0.1);
  out.overshoot = std::max(0.0, *std::max_element(response.begin(), response.end()) - 1.0);
  const auto last_outside =
      std::find_if(response.rbegin(), response.rend(), [](double y) { return std::abs(y - 1.0) > kSettled; });
  const auto settled = static_cast<std::size_t>(response.rend() - last_outside);
  out.settling_time_s = settled < response.size() ? step_s * static_cast<double>(settled) : kNone;
  return out;
}

void add_step(LoopStudy& study, const control::FlownLoop& loop, double duration_s) {
  const double step_s = duration_s / (kStepPoints - 1);
  const std::vector<double> response = control::step_response(loop, step_s, kLongPoints);
  study.step = study.stable ? figures_of(response, step_s) : StepFigures{kNone, kNone, kNone};
  for (std::size_t i = 0; i < kStepPoints; ++i) {
    if (!(std::abs(response[i]) < kDiverged)) break;
    study.time_s.push_back(step_s * static_cast<double>(i));
    study.response.push_back(response[i]);
  }
}

void add_bode(LoopStudy& study, const control::Loop& loop, double centre) {
  double phase_deg = -180.0;  // a double integrator's
  for (std::size_t i = 0; i < kBodePoints; ++i) {
    const double part = 2.0 * static_cast<double>(i) / (kBodePoints - 1) - 1.0;
    const double omega = centre * std::pow(kBodeRange, part);
    const std::complex<double> response = control::frequency_response(loop, omega);
    const double wrapped = std::arg(response) * 180.0 / M_PI;
    phase_deg = wrapped + 360.0 * std::round((phase_deg - wrapped) / 360.0);
    study.omega.push_back(omega);
    study.magnitude_db.push_back(20.0 * std::log10(std::abs(response)));
    study.phase_deg.push_back(phase_deg);
  }
}

// The lowest crossover of a loop over all settings; 1 rad/s if there is none.
double slowest_crossover(const std::vector<SettingsStudy>& settings, std::size_t loop) {
  double slowest = std::numeric_limits<double>::infinity();
  for (const SettingsStudy& one : settings)
    if (std::isfinite(one.loops[loop].crossover)) slowest = std::min(slowest, one.loops[loop].crossover);
  return std::isfinite(slowest) ? slowest : 1.0;
}

}  // namespace

TuningStudy study_tuning(const plant::Vehicle& vehicle, const std::vector<control::ControlSettings>& settings,
                         const LoopDelay& delay) {
  TuningStudy study{vehicle.name, vehicle.motor.time_constant_s, delay, {}};
  std::vector<std::array<control::FlownLoop, 6>> loops;
  for (const control::ControlSettings& one : settings) {
    loops.push_back(control::flown_loops(control::design(vehicle, one), one, delay.total_s()));
    SettingsStudy& added = study.settings.emplace_back();
    added.name = one.name;
    for (std::size_t i = 0; i < added.loops.size(); ++i) {
      const control::Loop& loop = loops.back()[i].loop;
      added.loops[i].stable = control::closed_loop_poles(loop).back().real() < 0.0;
      added.loops[i].crossover = decisive_crossover(loop);
      added.loops[i].margins = control::margins(loop);
    }
  }
  for (std::size_t i = 0; i < control::kFlownLoopNames.size(); ++i) {
    const double slowest = slowest_crossover(study.settings, i);
    for (std::size_t k = 0; k < loops.size(); ++k) {
      LoopStudy& loop = study.settings[k].loops[i];
      add_step(loop, loops[k][i], kStepRange / slowest);
      add_bode(loop, loops[k][i].loop, slowest);
    }
  }
  return study;
}

}  // namespace swiftlet::analysis
