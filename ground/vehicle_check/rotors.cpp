#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/ground/vehicle_check/checks.hpp"
#include "swiftlet/ground/vehicle_check/commands.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kLeastRise_rad_s = 20.0;
constexpr double kMostOfOthers = 0.5;          // of the rise of the fastest
constexpr double kLeastTurn_rad_s = 0.1;       // about x and y
constexpr double kLeastYaw_rad_s = 0.01;       // reaction torque
constexpr std::int64_t kMean_ns = 40'000'000;  // over which rates are averaged

const char* name_of(plant::Spin spin) {
  return spin == plant::Spin::kClockwise ? "clockwise" : "counter-clockwise";
}

std::string rotor_text(int rotor, const plant::Vehicle& vehicle) {
  return fmt::format("rotor {} ({})", rotor, place_of(vehicle.rotors[static_cast<std::size_t>(rotor - 1)]));
}

// What was seen for each commanded rotor.
using SeenRotors = std::vector<std::optional<int>>;

// The words of the checks of a rotor.
Words words_of(int rotor, const plant::Vehicle& vehicle) {
  return {{"rotor", rotor},
          {"asked", rotor_text(rotor, vehicle)},
          {"expected", name_of(vehicle.rotors[static_cast<std::size_t>(rotor - 1)].spin)}};
}

// not_seen: the finding if no rotor was seen.
CheckResult judge_order(const Check& check, double value, int rotor, const SeenRotors& seen,
                        const std::string& not_seen, const plant::Vehicle& vehicle, Words words) {
  const std::optional<int> answered = seen[static_cast<std::size_t>(rotor - 1)];
  if (!answered) return judge_by(check, value, not_seen, words);
  if (answered == rotor) return judge_by(check, value, "", words);
  words.emplace_back("answered", rotor_text(*answered, vehicle));
  const auto index = static_cast<std::size_t>(*answered - 1);
  const bool exchanged = index < seen.size() && seen[index] == rotor;
  return judge_by(check, value,
                  exchanged ? "two rotors exchanged: {asked} and {answered} answer each other's commands"
                            : "wrong order: the command of {asked} reaches {answered}",
                  words);
}

CheckResult judge_spin(const Check& check, double value, plant::Spin seen, plant::Spin expected,
                       Words words) {
  words.emplace_back("seen", name_of(seen));
  return judge_by(check, value,
                  seen == expected
                      ? ""
                      : "wrong spin: {asked} turns {seen} seen from above, the vehicle file says "
                        "{expected}; exchange two of its motor wires, and the propeller",
                  words);
}

// A phase for each rotor; empty if one is missing.
std::vector<const CommandPhase*> spins_of(const CommandPhases& phases, int rotor_count) {
  std::vector<const CommandPhase*> spins(static_cast<std::size_t>(rotor_count), nullptr);
  for (const CommandPhase& phase : phases) {
    if (phase.stage == CommandStage::kSpin && phase.rotor >= 1 && phase.rotor <= rotor_count)
      spins[static_cast<std::size_t>(phase.rotor - 1)] = &phase;
  }
  if (std::count(spins.begin(), spins.end(), nullptr) > 0) return {};
  return spins;
}

// The rotor that alone is faster than it was at idle.
struct Faster {
  std::optional<int> rotor;
  plant::PerRotor rises{};
};
Faster fastest_rotor(const VehicleRecording& recording, const CommandPhase& idle, const CommandPhase& spin,
                     int rotor_count) {
  const auto middle_of = [](const CommandPhase& phase) { return (phase.begin_ns + phase.end_ns) / 2; };
  const auto before = mean_rotor_speeds(recording, middle_of(idle), idle.end_ns);
  const auto now = mean_rotor_speeds(recording, middle_of(spin), spin.end_ns);
  Faster faster;
  if (!before || !now) return faster;
  std::size_t most = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count); ++i) {
    faster.rises[i] = (*now)[i] - (*before)[i];
    if (faster.rises[i] > faster.rises[most]) most = i;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(rotor_count); ++i) {
    if (i != most && faster.rises[i] > kMostOfOthers * faster.rises[most]) return faster;
  }
  if (faster.rises[most] >= kLeastRise_rad_s) faster.rotor = static_cast<int>(most) + 1;
  return faster;
}

// Body rates at a time, averaged.
std::optional<Eigen::Vector3d> rates_at(const VehicleRecording& recording, std::int64_t end_ns) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (const auto& received : recording.imu.samples) {
    if (received.received_ns < end_ns - kMean_ns || received.received_ns > end_ns) continue;
    sum += received.sample.imu.body_rates_frd;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return Eigen::Vector3d(sum / count);
}

// Angular acceleration by thrust of a rotor, Eq. (26) and (28), without its size: (-y, x) T and the reaction torque.
Eigen::Vector3d acceleration_of(const plant::RotorMount& mount, const plant::Vehicle& vehicle) {
  const double yaw = (mount.spin == plant::Spin::kCounterClockwise ? 1.0 : -1.0) * vehicle.rotor.torque /
                     vehicle.rotor.thrust;
  return vehicle.inertia.inverse() * Eigen::Vector3d(-mount.position_frd.y(), mount.position_frd.x(), yaw);
}

int most_like(const Eigen::Vector3d& change, const plant::Vehicle& vehicle) {
  int best = 1;
  double best_cosine = -2.0;
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor) {
    const Eigen::Vector2d expected =
        acceleration_of(vehicle.rotors[static_cast<std::size_t>(rotor - 1)], vehicle).head<2>();
    const double cosine = change.head<2>().dot(expected) / (change.head<2>().norm() * expected.norm());
    if (cosine > best_cosine) {
      best = rotor;
      best_cosine = cosine;
    }
  }
  return best;
}

}  // namespace

std::string place_of(const plant::RotorMount& mount) {
  const double x = mount.position_frd.x();
  const double y = mount.position_frd.y();
  constexpr double kBeside = 0.2;  // of the arm: neither front nor rear, neither right nor left
  const double beside = kBeside * std::hypot(x, y);
  std::string text = x > beside ? "front" : x < -beside ? "rear" : "";
  if (std::abs(y) > beside) text += (text.empty() ? "" : " ") + std::string(y > 0.0 ? "right" : "left");
  return text.empty() ? "centre" : text;
}

CheckResults check_rotor_spins(const VehicleRecording& recording, const CommandPhases& phases,
                               const plant::Vehicle& vehicle) {
  const int count = vehicle.rotor_count();
  const CommandPhase* const idle = phase_of(phases, CommandStage::kIdle);
  const std::vector<const CommandPhase*> spins = spins_of(phases, count);
  if (idle == nullptr || spins.empty())
    return {missing("rotors.steps", "missing: not every rotor was turned by itself")};
  const bool measured = !recording.rotor_speeds.samples.empty();
  std::vector<Faster> faster;
  SeenRotors seen;
  for (const CommandPhase* const spin : spins) {
    faster.push_back(fastest_rotor(recording, *idle, *spin, count));
    seen.push_back(spin->seen_rotor ? spin->seen_rotor : faster.back().rotor);
  }
  CheckResults results;
  for (int rotor = 1; rotor <= count; ++rotor) {
    const auto i = static_cast<std::size_t>(rotor - 1);
    const CommandPhase& spin = *spins[i];
    const Words words = words_of(rotor, vehicle);
    const std::string name = fmt::format("rotor_{}.", rotor);
    if (!seen[i] && !measured)
      results.push_back(skipped(
          name + "order", "rotor_speeds is not published, and nobody at a terminal confirmed the rotor"));
    else
      results.push_back(judge_order(spin.seen_rotor ? kOrderSeen : kOrderBySpeeds,
                                    spin.seen_rotor ? *spin.seen_rotor : faster[i].rises[i], rotor, seen,
                                    "no rotor, or more than one, turns faster on the command of {asked}",
                                    vehicle, words));
    if (measured && spin.seen_rotor && faster[i].rotor && faster[i].rotor != spin.seen_rotor)
      results.push_back(
          missing(name + "speeds",
                  fmt::format("rotor_speeds are numbered otherwise: rotor {} was seen, rotor {} is reported",
                              *spin.seen_rotor, *faster[i].rotor)));
    results.push_back(
        spin.seen_spin
            ? judge_spin(kSpinSeen, *spin.seen_spin == plant::Spin::kClockwise ? 1.0 : -1.0, *spin.seen_spin,
                         vehicle.rotors[i].spin, words)
            : skipped(name + "spin", "nobody at a terminal confirmed the direction; --tethered measures it"));
  }
  return results;
}

CheckResults check_rotor_thrusts(const VehicleRecording& recording, const CommandPhases& phases,
                                 const plant::Vehicle& vehicle) {
  const std::vector<const CommandPhase*> spins = spins_of(phases, vehicle.rotor_count());
  if (spins.empty()) return {missing("rotors.steps", "missing: not every rotor was raised by itself")};
  std::vector<std::optional<Eigen::Vector3d>> changes;
  SeenRotors seen;
  for (const CommandPhase* const spin : spins) {
    const auto before = rates_at(recording, spin->begin_ns);
    const auto after = rates_at(recording, spin->end_ns);
    changes.emplace_back();
    seen.emplace_back();
    if (!before || !after) continue;
    changes.back() = *after - *before;
    if (changes.back()->head<2>().norm() >= kLeastTurn_rad_s)
      seen.back() = most_like(*changes.back(), vehicle);
  }
  CheckResults results;
  for (int rotor = 1; rotor <= vehicle.rotor_count(); ++rotor) {
    const auto i = static_cast<std::size_t>(rotor - 1);
    if (!changes[i]) {
      results.push_back(
          missing(fmt::format("rotor_{}.order", rotor), "missing: no imu message arrived in this step"));
      continue;
    }
    const Eigen::Vector3d& change = *changes[i];
    Words words = words_of(rotor, vehicle);
    words.emplace_back("turn", to_string(change, 2));
    results.push_back(judge_order(kOrderByTurn, change.head<2>().norm(), rotor, seen,
                                  "the vehicle does not turn when {asked} is raised: it is held too tightly, "
                                  "or the rotor gives no thrust",
                                  vehicle, words));
    const plant::Spin spin = change.z() > 0.0 ? plant::Spin::kCounterClockwise : plant::Spin::kClockwise;
    results.push_back(std::abs(change.z()) < kLeastYaw_rad_s
                          ? judge_by(kSpinByTurn, change.z(),
                                     "the vehicle shows no reaction torque: it cannot turn about z", words)
                          : judge_spin(kSpinByTurn, change.z(), spin, vehicle.rotors[i].spin, words));
  }
  return results;
}

}  // namespace swiftlet::ground
