#include "swiftlet/plant/simulation/links/faults.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/time.hpp"

namespace swiftlet::plant {

namespace {

constexpr double kLongest_s = 86'400.0;  // one day
constexpr double kLongestDelay_s = 1.0;

std::string key_of(std::size_t index) { return "faults[" + std::to_string(index) + "]"; }

class ParameterChecker {
 public:
  ParameterChecker(std::string key, RuleChecker& check) : key_(std::move(key)), check_(check) {}

  void number(const char* name, double value, double min, double max) {
    check_.between(key_ + "." + name, value, min, max);
  }
  void vector(const char* name, const Eigen::Vector3d& value, double most) {
    for (int i = 0; i < 3; ++i)
      check_.between(key_ + "." + name + "[" + std::to_string(i) + "]", value[i], -most, most);
  }

 private:
  std::string key_;
  RuleChecker& check_;
};

void check_parameters(const Fault& fault, ParameterChecker check) {
  switch (fault.kind) {
    case FaultKind::kMocapJump:
      check.vector("position_ned_m", fault.position_ned, 100.0);
      check.vector("rotation_frd_rad", fault.rotation_frd, 2.0 * M_PI);
      return;
    case FaultKind::kMocapSwap:
    case FaultKind::kOdometryJump:
      check.vector("position_ned_m", fault.position_ned, 100.0);
      check.number("yaw_rad", fault.yaw_rad, -2.0 * M_PI, 2.0 * M_PI);
      return;
    case FaultKind::kMocapLatency:
    case FaultKind::kCommandsDelay:
      check.number("delay_s", fault.delay_s, 0.001, kLongestDelay_s);
      return;
    case FaultKind::kImuBias:
      check.vector("accelerometer_m_s2", fault.specific_force_frd, 200.0);
      check.vector("gyro_rad_s", fault.body_rates_frd, 50.0);
      return;
    case FaultKind::kBatteryDrop:
      check.number("voltage_v", fault.voltage_v, 0.0, 100.0);
      return;
    case FaultKind::kRotorThrust:
      check.number("rotor", fault.rotor, 1, kMaxRotors);
      check.number("factor", fault.factor, 0.0, 1.0);
      return;
    case FaultKind::kPush:
      check.vector("force_ned_n", fault.force_ned, 1000.0);
      check.vector("moment_frd_n_m", fault.moment_frd, 1000.0);
      return;
    case FaultKind::kWind:
      check.vector("wind_ned_m_s", fault.wind_ned, 30.0);
      return;
    default:
      return;
  }
}

bool overlap(const Fault& a, const Fault& b) {
  return a.at_s < b.at_s + b.for_s && b.at_s < a.at_s + a.for_s;
}

}  // namespace

void check_faults(const std::vector<Fault>& faults, double step_s, RuleChecker& check) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const Fault& fault = faults[i];
    check.between(key_of(i) + ".at_s", fault.at_s, 0.0, kLongest_s);
    check.between(key_of(i) + ".for_s", fault.for_s, step_s, kLongest_s);
    check_parameters(fault, ParameterChecker(key_of(i), check));
    for (std::size_t k = 0; k < i; ++k) {
      if (faults[k].kind != fault.kind || !overlap(faults[k], fault)) continue;
      check.add(key_of(i) + ".at_s", "is ", fault.at_s, ", but ", key_of(k), ", ", to_string(fault.kind),
                " too, lasts from ", faults[k].at_s, " s to ", faults[k].at_s + faults[k].for_s,
                " s: faults of one kind must not overlap");
    }
  }
}

std::vector<Violation> validate_faults(const std::vector<Fault>& faults, const Vehicle& vehicle) {
  RuleChecker check;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (faults[i].kind != FaultKind::kRotorThrust || faults[i].rotor <= vehicle.rotor_count()) continue;
    check.add(key_of(i) + ".rotor", "is ", faults[i].rotor, ", must be at most ", vehicle.rotor_count(),
              ", the rotors of ", vehicle.name);
  }
  return check.take();
}

FaultSchedule::FaultSchedule(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    const Entry entry{math::nanoseconds(fault.at_s), math::nanoseconds(fault.at_s + fault.for_s), fault};
    by_kind_[static_cast<std::size_t>(fault.kind)].push_back(entry);
    changes_ns_.insert(changes_ns_.end(), {entry.from_ns, entry.to_ns});
  }
  for (std::vector<Entry>& entries : by_kind_) {
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.from_ns < b.from_ns; });
  }
  std::sort(changes_ns_.begin(), changes_ns_.end());
}

const Fault* FaultSchedule::active(FaultKind kind, std::int64_t stamp_ns) const {
  const std::vector<Entry>& entries = of(kind);
  const auto later = std::upper_bound(entries.begin(), entries.end(), stamp_ns,
                                      [](std::int64_t stamp, const Entry& e) { return stamp < e.from_ns; });
  if (later == entries.begin()) return nullptr;
  const Entry& begun = *std::prev(later);
  return stamp_ns < begun.to_ns ? &begun.fault : nullptr;
}

std::int64_t FaultSchedule::next_change_ns(std::int64_t stamp_ns) const {
  const auto next = std::upper_bound(changes_ns_.begin(), changes_ns_.end(), stamp_ns);
  return next == changes_ns_.end() ? kNever : *next;
}

double FaultSchedule::longest_delay_s(FaultKind kind) const {
  double longest = 0.0;
  for (const Entry& entry : of(kind)) longest = std::max(longest, entry.fault.delay_s);
  return longest;
}

}  // namespace swiftlet::plant
