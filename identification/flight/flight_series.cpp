#include "swiftlet/identification/flight/flight_series.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_checks.hpp"
#include "swiftlet/identification/flight/motor_order.hpp"
#include "swiftlet/plant/model/propulsion.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kValidationShare = 0.2;
constexpr double kHalfSmoothingS = 0.06;   // s, half the window of the polynomial through poses
constexpr std::size_t kLeastPoses = 5;     // of that polynomial
constexpr double kLongestPoseGapS = 0.25;  // s, longest allowed gap between poses

void require_whole(const FlightLog& log, const Rows& rows) {
  for (std::size_t i = rows.first + 1; i < rows.last; ++i) {
    if (log.time_s[i] - log.time_s[i - 1] <= kLongestRowGapS) continue;
    throw BadData("has no sample for " + format_number(log.time_s[i] - log.time_s[i - 1]) +
                  " s in the flight, after " + format_number(log.time_s[i - 1]) + " s, must have one every " +
                  format_number(kLongestRowGapS) + " s");
  }
}

SpeedSource source_of(const FlightLog& log) {
  if (log.poses.size() <= kLeastPoses || log.supply_voltage_v.empty()) return SpeedSource::kCommanded;
  return log.rotor_speeds.empty() ? SpeedSource::kModelled : SpeedSource::kMeasured;
}

std::vector<plant::PerRotor> steady_speeds(const FlightLog& log, const plant::Vehicle& base) {
  std::vector<plant::PerRotor> out(log.size(), plant::PerRotor{});
  for (std::size_t row = 0; row < log.size(); ++row) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(log.rotor_count); ++i) {
      if (log.running[row] == 0) continue;
      out[row][i] = plant::steady_speed_from_throttle(base, log.supply_voltage_v[row], log.command[row][i]);
    }
  }
  return out;
}

struct Motion {
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();
};

// Motion at a time: velocity from a cubic polynomial through the nearby positions, attitude by slerp between
// the two neighbouring poses.
class PoseMotion {
 public:
  explicit PoseMotion(const std::vector<FlightPose>& poses) : poses_(poses) {}

  // Times must increase from call to call.
  Motion at(double time_s) {
    while (next_ + 1 < poses_.size() && poses_[next_].time_s <= time_s) ++next_;
    if (next_ == 0) next_ = 1;
    const FlightPose& before = poses_[next_ - 1];
    const FlightPose& after = poses_[next_];
    if (time_s < before.time_s - kLongestPoseGapS || time_s > after.time_s + kLongestPoseGapS) {
      throw BadData("has poses only from " + format_number(poses_.front().time_s) + " to " +
                    format_number(poses_.back().time_s) + " s, but flight at " + format_number(time_s) +
                    " s; must have them all through the flight");
    }
    if (after.time_s - before.time_s > kLongestPoseGapS) {
      throw BadData("has no pose for " + format_number(after.time_s - before.time_s) +
                    " s in the flight, after " + format_number(before.time_s) + " s, must have one every " +
                    format_number(kLongestPoseGapS) + " s");
    }
    const double share = std::clamp((time_s - before.time_s) / (after.time_s - before.time_s), 0.0, 1.0);
    return {velocity(time_s), before.q_ned_from_frd.slerp(share, after.q_ned_from_frd)};
  }

 private:
  Eigen::Vector3d velocity(double time_s) const {
    std::size_t first = next_;
    std::size_t last = next_;
    while (first > 0 &&
           (time_s - poses_[first - 1].time_s < kHalfSmoothingS || last - first < kLeastPoses / 2 + 1))
      --first;
    while (last < poses_.size() &&
           (poses_[last].time_s - time_s < kHalfSmoothingS || last - first < kLeastPoses))
      ++last;
    Eigen::Matrix<double, Eigen::Dynamic, 4> powers(static_cast<Eigen::Index>(last - first), 4);
    Eigen::Matrix<double, Eigen::Dynamic, 3> positions(powers.rows(), 3);
    for (std::size_t i = first; i < last; ++i) {
      const double t = poses_[i].time_s - time_s;
      powers.row(static_cast<Eigen::Index>(i - first)) << 1.0, t, t * t, t * t * t;
      positions.row(static_cast<Eigen::Index>(i - first)) = poses_[i].position_ned.transpose();
    }
    const Eigen::Matrix<double, 4, 3> fit =
        (powers.transpose() * powers).ldlt().solve(powers.transpose() * positions);
    return fit.row(1).transpose();
  }

  const std::vector<FlightPose>& poses_;
  std::size_t next_ = 0;
};

void add_motion(FlightSeries& series) {
  const FlightLog& log = *series.log;
  series.velocity_ned.resize(log.size(), Eigen::Vector3d::Zero());
  series.attitude.resize(log.size(), Eigen::Quaterniond::Identity());
  std::vector<FlightPose> poses = log.poses;
  if (series.pose_timing.identified) {
    for (FlightPose& pose : poses) pose.time_s -= series.pose_timing.delay.value;
  }
  PoseMotion motion(poses);
  for (std::size_t row = series.window.flight.first; row < series.window.flight.last; ++row) {
    const Motion now = motion.at(log.time_s[row]);
    series.velocity_ned[row] = now.velocity_ned;
    series.attitude[row] = now.attitude;
  }
}

std::vector<Rows> segments_of(const FlightLog& log, const Rows& rows) {
  std::vector<Rows> out;
  std::size_t first = rows.first;
  for (std::size_t i = rows.first; i < rows.last; ++i) {
    if (log.time_s[i] - log.time_s[first] < kSegmentS) continue;
    out.push_back({first, i});
    first = i;
  }
  return out;
}

FlightSeries prepare_flight(const FlightLog& log, const plant::Vehicle& base, const FlightBounds& bounds) {
  if (log.rotor_count != base.rotor_count()) {
    throw BadData("has commands of " + std::to_string(log.rotor_count) + " motors, must have " +
                  std::to_string(base.rotor_count()) + ", the number of rotors of " + base.name);
  }
  FlightSeries out;
  out.log = &log;
  require_times(log);
  out.window = find_flight(log, bounds);
  require_whole(log, out.window.flight);
  require_readings(log, out.window.flight);
  require_motor_order(log, out.window.flight, base);
  const Rows& flight = out.window.flight;
  out.estimation_set = {
      flight.first,
      flight.last - static_cast<std::size_t>(kValidationShare * static_cast<double>(flight.size()))};
  out.validation_set = {out.estimation_set.last, flight.last};
  out.source = source_of(log);
  if (out.source == SpeedSource::kCommanded) return out;
  out.steady_speeds = steady_speeds(log, base);
  require_speeds_match_motors(out, base);
  out.segments = segments_of(log, out.estimation_set);
  out.pose_timing = find_pose_timing(log, out.segments);
  add_motion(out);
  require_positions_match_force(out);
  return out;
}

}  // namespace

std::vector<FlightSeries> prepare_flights(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                          const FlightBounds& bounds) {
  std::vector<FlightSeries> out;
  for (const FlightLog& log : logs) {
    try {
      out.push_back(prepare_flight(log, base, bounds));
    } catch (const BadData& fault) {
      throw BadData(log.name + ": " + fault.what(), fault.row());
    }
    if (out.back().source == out.front().source) continue;
    throw BadData(
        log.name + " and " + logs.front().name +
        " hold different data: poses, supply voltage and rotor speeds must each be in all logs or in none");
  }
  return out;
}

std::vector<plant::PerRotor> lagged_speeds(const FlightLog& log, const std::vector<plant::PerRotor>& steady,
                                           const Rows& rows, double time_constant_s, double delay_s) {
  const auto rotors = static_cast<std::size_t>(log.rotor_count);
  std::vector<plant::PerRotor> out(rows.size(), plant::PerRotor{});
  plant::PerRotor speed = steady.front();
  std::size_t to = rows.first;
  for (std::size_t row = 0; row < steady.size() && to < rows.last; ++row) {
    const bool is_last = row + 1 == steady.size();
    for (; to < rows.last && (is_last || log.time_s[to] - delay_s < log.time_s[row + 1]); ++to) {
      const double ahead = std::max(log.time_s[to] - delay_s - log.time_s[row], 0.0);
      const double left = std::exp(-ahead / time_constant_s);
      for (std::size_t i = 0; i < rotors; ++i)
        out[to - rows.first][i] = steady[row][i] + (speed[i] - steady[row][i]) * left;
    }
    if (is_last) break;
    const double left = std::exp(-(log.time_s[row + 1] - log.time_s[row]) / time_constant_s);
    for (std::size_t i = 0; i < rotors; ++i) speed[i] = steady[row][i] + (speed[i] - steady[row][i]) * left;
  }
  return out;
}

}  // namespace swiftlet::identification
