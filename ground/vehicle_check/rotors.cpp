#include "swiftlet/ground/vehicle_check/rotors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/ground/vehicle_check/rotor_activity.hpp"

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

std::string rotor_name(int rotor, const char* subject) { return fmt::format("rotor_{}.{}", rotor, subject); }

std::string rotor_text(int rotor, const plant::Vehicle& vehicle) {
  return fmt::format("rotor {} ({})", rotor, place_of(vehicle.rotors[static_cast<std::size_t>(rotor - 1)]));
}

// What was seen for each commanded rotor.
using SeenRotors = std::vector<std::optional<int>>;

std::string order_finding(int rotor, const SeenRotors& seen, const plant::Vehicle& vehicle) {
  const int answered = *seen[static_cast<std::size_t>(rotor - 1)];
  if (answered == rotor) return "";
  const auto index = static_cast<std::size_t>(answered - 1);
  if (index < seen.size() && seen[index] == rotor)
    return fmt::format("two rotors exchanged: {} and {} answer each other's commands",
                       rotor_text(rotor, vehicle), rotor_text(answered, vehicle));
  return fmt::format("wrong order: the command of {} reaches {}", rotor_text(rotor, vehicle),
                     rotor_text(answered, vehicle));
}

std::string spin_finding(int rotor, plant::Spin seen, const plant::Vehicle& vehicle) {
  const plant::Spin expected = vehicle.rotors[static_cast<std::size_t>(rotor - 1)].spin;
  if (seen == expected) return "";
  return fmt::format(
      "wrong spin: {} turns {} seen from above, the vehicle file says {}; exchange two of its motor wires, "
      "and the propeller",
      rotor_text(rotor, vehicle), name_of(seen), name_of(expected));
}

std::vector<const CommandPhase*> spins_of(const CommandPhases& phases, int rotor_count) {
  std::vector<const CommandPhase*> spins(static_cast<std::size_t>(rotor_count), nullptr);
  for (const CommandPhase& phase : phases) {
    if (phase.stage == CommandStage::kSpin && phase.rotor >= 1 && phase.rotor <= rotor_count)
      spins[static_cast<std::size_t>(phase.rotor - 1)] = &phase;
  }
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
  if (idle == nullptr || std::count(spins.begin(), spins.end(), nullptr) > 0)
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
    const std::string order = rotor_name(rotor, "order");
    Figure shown = figure(faster[i].rises[i], "rad/s", 0, " faster than idle");
    if (spins[i]->seen_rotor)
      shown = {static_cast<double>(*seen[i]), "", fmt::format("rotor {} seen", *seen[i])};
    const std::string limit = "only " + rotor_text(rotor, vehicle) + " faster";
    if (seen[i]) {
      results.push_back(judged(order, shown, limit, order_finding(rotor, seen, vehicle)));
      if (measured && spins[i]->seen_rotor && faster[i].rotor && faster[i].rotor != spins[i]->seen_rotor)
        results.push_back(missing(
            rotor_name(rotor, "speeds"),
            fmt::format("rotor_speeds are numbered otherwise: rotor {} was seen, rotor {} is reported",
                        *spins[i]->seen_rotor, *faster[i].rotor)));
    } else if (measured) {
      results.push_back(
          judged(order, shown, limit,
                 "no rotor, or more than one, turns faster on the command of " + rotor_text(rotor, vehicle)));
    } else {
      results.push_back(
          skipped(order, "rotor_speeds is not published, and nobody at a terminal confirmed the rotor"));
    }
    const std::string spin = rotor_name(rotor, "spin");
    if (spins[i]->seen_spin) {
      results.push_back(judged(
          spin,
          {*spins[i]->seen_spin == plant::Spin::kClockwise ? 1.0 : -1.0, "", name_of(*spins[i]->seen_spin)},
          name_of(vehicle.rotors[i].spin), spin_finding(rotor, *spins[i]->seen_spin, vehicle)));
    } else {
      results.push_back(
          skipped(spin, "nobody at a terminal confirmed the direction; --tethered measures it"));
    }
  }
  return results;
}

CheckResults check_rotor_thrusts(const VehicleRecording& recording, const CommandPhases& phases,
                                 const plant::Vehicle& vehicle) {
  const std::vector<const CommandPhase*> spins = spins_of(phases, vehicle.rotor_count());
  if (std::count(spins.begin(), spins.end(), nullptr) > 0)
    return {missing("rotors.steps", "missing: not every rotor was raised by itself")};
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
    const std::string order = rotor_name(rotor, "order");
    const std::string spin = rotor_name(rotor, "spin");
    if (!changes[i]) {
      results.push_back(missing(order, "missing: no imu message arrived in this step"));
      continue;
    }
    const Eigen::Vector3d& change = *changes[i];
    const Figure shown{change.head<2>().norm(), "rad/s", "turn of " + to_string(change, 2) + " rad/s"};
    results.push_back(judged(order, shown, "as thrust of " + rotor_text(rotor, vehicle),
                             seen[i]
                                 ? order_finding(rotor, seen, vehicle)
                                 : "the vehicle does not turn when " + rotor_text(rotor, vehicle) +
                                       " is raised: it is held too tightly, or the rotor gives no thrust"));
    const plant::Spin shown_spin =
        change.z() > 0.0 ? plant::Spin::kCounterClockwise : plant::Spin::kClockwise;
    std::string finding = spin_finding(rotor, shown_spin, vehicle);
    if (std::abs(change.z()) < kLeastYaw_rad_s)
      finding = "the vehicle shows no reaction torque: it cannot turn about z";
    results.push_back(judged(spin, figure(change.z(), "rad/s", 3, " about z"),
                             std::string("as ") + name_of(vehicle.rotors[i].spin), finding));
  }
  return results;
}

}  // namespace swiftlet::ground
