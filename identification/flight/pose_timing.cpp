#include "swiftlet/identification/flight/pose_timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/series_fit.hpp"
#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kLeastPosesOfSegment = 3;  // in a segment
constexpr std::size_t kLeastSegments = 8;
constexpr double kLongestDelayS = 1.0;
constexpr double kLagStepS = 0.01;  // s, step of the first search
constexpr double kLagOffS = 0.05;   // s, largest error of the first search
constexpr double kSpanS = 0.05;     // s, span over which it compares rotations
constexpr double kTurning = 0.25;   // rad/s, least RMS rate over such spans to compare
constexpr double kLeastRateCorrelation = 0.5;
constexpr double kMostOfGyro = 1.25;            // of the poses' rotation over the gyro's, and its inverse
constexpr double kMostDelayHalfWidthS = 0.002;  // s, of an identified delay

// Rotation of the body since about since_s, integrated from the gyro less its offset.
class Turned {
 public:
  Turned(const FlightLog& log, const Vector3d& offset, double since_s) : log_(log), offset_(offset) {
    const auto next = std::upper_bound(log.time_s.begin(), log.time_s.end(), since_s);
    row_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - log.time_s.begin() - 1, 0));
  }

  // Times must increase from call to call.
  Quaterniond at(double time_s) {
    while (row_ + 1 < log_.size() && log_.time_s[row_ + 1] <= time_s) {
      turned_ = math::renormalised(turned_ * step(log_.time_s[row_ + 1]));
      ++row_;
    }
    return turned_ * step(time_s);
  }

 private:
  // Rotation from the current row to a time that is not after the next row. Rates are linear between rows.
  Quaterniond step(double to_s) const {
    const double passed_s = std::max(to_s - log_.time_s[row_], 0.0);
    Vector3d rates = log_.body_rates_frd[row_];
    if (row_ + 1 < log_.size()) {
      const double share = passed_s / (log_.time_s[row_ + 1] - log_.time_s[row_]);
      rates += 0.5 * std::min(share, 1.0) * (log_.body_rates_frd[row_ + 1] - log_.body_rates_frd[row_]);
    }
    return math::rotation(passed_s * (rates - offset_));
  }

  const FlightLog& log_;
  Vector3d offset_;
  std::size_t row_ = 0;
  Quaterniond turned_ = Quaterniond::Identity();
};

// Poses of one segment.
struct Poses {
  std::size_t first = 0;
  std::size_t last = 0;  // not included
};

std::vector<Poses> poses_of(const FlightLog& log, const std::vector<Rows>& segments) {
  const auto at = [&](double time_s) {
    return static_cast<std::size_t>(
        std::lower_bound(log.poses.begin(), log.poses.end(), time_s,
                         [](const FlightPose& pose, double t) { return pose.time_s < t; }) -
        log.poses.begin());
  };
  std::vector<Poses> out;
  for (const Rows& segment : segments) {
    const Poses poses{at(log.time_s[segment.first]), at(log.time_s[segment.last - 1])};
    if (poses.last - poses.first >= kLeastPosesOfSegment) out.push_back(poses);
  }
  return out;
}

// Integral of the gyro's rates, rad, interpolated at any time of a log.
class GyroIntegral {
 public:
  explicit GyroIntegral(const FlightLog& log) : time_s_(log.time_s), integral_(log.size(), Vector3d::Zero()) {
    for (std::size_t i = 1; i < integral_.size(); ++i) {
      integral_[i] = integral_[i - 1] + 0.5 * (time_s_[i] - time_s_[i - 1]) *
                                            (log.body_rates_frd[i] + log.body_rates_frd[i - 1]);
    }
  }

  Vector3d at(double time_s) const {
    const auto next = std::upper_bound(time_s_.begin(), time_s_.end(), time_s) - time_s_.begin();
    if (next == 0) return integral_.front();
    const auto after = static_cast<std::size_t>(next);
    if (after == integral_.size()) return integral_.back();
    const double share = (time_s - time_s_[after - 1]) / (time_s_[after] - time_s_[after - 1]);
    return integral_[after - 1] + share * (integral_[after] - integral_[after - 1]);
  }

 private:
  const std::vector<double>& time_s_;
  std::vector<Vector3d> integral_;
};

// The lag, s, with the highest correlation of the rates of poses and gyro. 0 if the vehicle hardly turns.
double rough_delay(const FlightLog& log, const std::vector<Poses>& segments) {
  struct Span {
    double from_s;
    double to_s;
  };
  std::vector<Span> spans;
  std::vector<double> by_poses;  // rad/s, x, y, z of each span
  for (const Poses& segment : segments) {
    std::size_t from = segment.first;
    for (std::size_t to = from + 1; to < segment.last; ++to) {
      const double length_s = log.poses[to].time_s - log.poses[from].time_s;
      if (length_s < kSpanS) continue;
      const Vector3d rates =
          math::rotation_vector(log.poses[from].q_ned_from_frd.conjugate() * log.poses[to].q_ned_from_frd) /
          length_s;
      spans.push_back({log.poses[from].time_s, log.poses[to].time_s});
      by_poses.insert(by_poses.end(), rates.begin(), rates.end());
      from = to;
    }
  }
  if (spans.empty()) return 0.0;
  const GyroIntegral integral(log);
  double best_s = 0.0;
  Comparison best;
  best.correlation = -2.0;
  const int most = static_cast<int>(std::lround(kLongestDelayS / kLagStepS));
  for (int i = -most; i <= most; ++i) {
    const double lag_s = i * kLagStepS;
    std::vector<double> by_gyro;
    by_gyro.reserve(by_poses.size());
    for (const Span& span : spans) {
      const Vector3d rates =
          (integral.at(span.to_s - lag_s) - integral.at(span.from_s - lag_s)) / (span.to_s - span.from_s);
      by_gyro.insert(by_gyro.end(), rates.begin(), rates.end());
    }
    const Comparison found = compared(by_poses, by_gyro);
    if (found.correlation <= best.correlation) continue;
    best = found;
    best_s = lag_s;
  }
  if (best.spread < kTurning) return 0.0;
  if (best.correlation < kLeastRateCorrelation) {
    throw BadData("poses: do not turn as the gyro does, at any delay up to " + format_number(kLongestDelayS) +
                  " s (correlation " + format_number(best.correlation) + ", must be above " +
                  format_number(kLeastRateCorrelation) + "); are their frames and clocks right?");
  }
  if (best.ratio > kMostOfGyro || best.ratio < 1.0 / kMostOfGyro) {
    throw BadData("body rates: the poses turn " + format_number(best.ratio) +
                  " times as far as the gyro, must be " + format_number(1.0 / kMostOfGyro) + " to " +
                  format_number(kMostOfGyro) + "; is the unit right?");
  }
  return best_s;
}

// Channels x, y, z: for each pose its rotation less that of the gyro, rad, less the mean over the segment.
void residuals(const FlightLog& log, const std::vector<Poses>& segments, const VectorXd& x, VectorXd& out) {
  const Index rows = out.size() / 3;
  Index begin = 0;
  for (const Poses& segment : segments) {
    const double start_s = log.poses[segment.first].time_s - x[0];
    Turned turned(log, x.tail<3>(), start_s);
    const auto count = static_cast<Index>(segment.last - segment.first);
    Quaterniond start;
    for (Index i = 0; i < count; ++i) {
      const FlightPose& pose = log.poses[segment.first + static_cast<std::size_t>(i)];
      const Quaterniond begun = pose.q_ned_from_frd * turned.at(pose.time_s - x[0]).conjugate();
      if (i == 0) start = begun;
      const Vector3d apart = math::rotation_vector(start.conjugate() * begun);
      for (Index axis = 0; axis < 3; ++axis) out[axis * rows + begin + i] = apart[axis];
    }
    for (Index axis = 0; axis < 3; ++axis) {
      auto channel = out.segment(axis * rows + begin, count);
      channel.array() -= channel.mean();
    }
    begin += count;
  }
}

}  // namespace

PoseTiming find_pose_timing(const FlightLog& log, const std::vector<Rows>& segments) {
  const std::vector<Poses> poses = poses_of(log, segments);
  PoseTiming out;
  out.delay = {"delay.poses", "T_p", "s"};
  for (std::size_t i = 0; i < 3; ++i)
    out.gyro_offset[i] = {std::string("gyro_offset.") + "xyz"[i], std::string("b_w") + "xyz"[i], "rad/s"};
  if (poses.size() < kLeastSegments) return out;

  SeriesProblem problem;
  const double delay_s = rough_delay(log, poses);
  problem.start = Eigen::Vector4d(delay_s, 0.0, 0.0, 0.0);
  problem.scale = Eigen::Vector4d(2e-3, 0.01, 0.01, 0.01);
  problem.low = Eigen::Vector4d(delay_s - kLagOffS, -1.0, -1.0, -1.0);
  problem.high = Eigen::Vector4d(delay_s + kLagOffS, 1.0, 1.0, 1.0);
  problem.segment_count = poses.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = problem.segments.size();
    for (std::size_t segment = 0; segment < poses.size(); ++segment)
      problem.segments.insert(problem.segments.end(), poses[segment].last - poses[segment].first, segment);
    problem.channels.push_back({first, problem.segments.size() - first});
  }
  problem.residuals = [&](const VectorXd& x, VectorXd& at) { residuals(log, poses, x, at); };

  const SeriesFit fit = fit_series(problem);
  const double factor = interval_factor(fit.degrees_of_freedom);
  const auto set_estimate = [&](ParameterEstimate& estimate, Index i) {
    estimate.value = fit.parameters[i];
    estimate.standard_error = fit.standard_error(i);
    estimate.half_width = factor * estimate.standard_error;
  };
  set_estimate(out.delay, 0);
  for (std::size_t i = 0; i < 3; ++i) set_estimate(out.gyro_offset[i], static_cast<Index>(i) + 1);
  out.identified = fit.converged && out.delay.half_width < kMostDelayHalfWidthS;
  return out;
}

}  // namespace swiftlet::identification
