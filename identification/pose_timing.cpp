#include "identification/pose_timing.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "identification/series_fit.hpp"
#include "plant/model/rotation_vector.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kLeastPoses = 3;  // of a stretch
constexpr std::size_t kLeastStretches = 8;
constexpr double kLongestDelayS = 0.2;
constexpr double kToldS = 0.002;  // half an interval of the delay up to which it counts as told

// What the body has turned, by the gyro less its offset, since about a time.
class Turned {
 public:
  Turned(const FlightLog& log, const Vector3d& offset, double since_s) : log_(log), offset_(offset) {
    const auto next = std::upper_bound(log.time_s.begin(), log.time_s.end(), since_s);
    row_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - log.time_s.begin() - 1, 0));
  }

  // Times must rise from call to call.
  Quaterniond at(double time_s) {
    while (row_ + 1 < log_.size() && log_.time_s[row_ + 1] <= time_s) {
      turned_ = plant::renormalised(turned_ * step(log_.time_s[row_ + 1]));
      ++row_;
    }
    return turned_ * step(time_s);
  }

 private:
  // From the present row to a time that is not after the next row. Between rows, rates go straight.
  Quaterniond step(double to_s) const {
    const double passed_s = std::max(to_s - log_.time_s[row_], 0.0);
    Vector3d rates = log_.body_rates_frd[row_];
    if (row_ + 1 < log_.size()) {
      const double share = passed_s / (log_.time_s[row_ + 1] - log_.time_s[row_]);
      rates += 0.5 * std::min(share, 1.0) * (log_.body_rates_frd[row_ + 1] - log_.body_rates_frd[row_]);
    }
    return plant::rotation(passed_s * (rates - offset_));
  }

  const FlightLog& log_;
  Vector3d offset_;
  std::size_t row_ = 0;
  Quaterniond turned_ = Quaterniond::Identity();
};

// Poses of one stretch.
struct Poses {
  std::size_t first = 0;
  std::size_t last = 0;  // not included
};

std::vector<Poses> poses_of(const FlightLog& log, const std::vector<Rows>& stretches) {
  const auto at = [&](double time_s) {
    return static_cast<std::size_t>(
        std::lower_bound(log.poses.begin(), log.poses.end(), time_s,
                         [](const FlightPose& pose, double t) { return pose.time_s < t; }) -
        log.poses.begin());
  };
  std::vector<Poses> out;
  for (const Rows& stretch : stretches) {
    const Poses poses{at(log.time_s[stretch.first]), at(log.time_s[stretch.last - 1])};
    if (poses.last - poses.first >= kLeastPoses) out.push_back(poses);
  }
  return out;
}

// Channels x, y, z: of each pose what it has turned beyond the gyro, rad, less the mean of its stretch.
void residuals(const FlightLog& log, const std::vector<Poses>& stretches, const VectorXd& x, VectorXd& out) {
  const Index rows = out.size() / 3;
  Index begin = 0;
  for (const Poses& stretch : stretches) {
    const double start_s = log.poses[stretch.first].time_s - x[0];
    Turned turned(log, x.tail<3>(), start_s);
    const auto count = static_cast<Index>(stretch.last - stretch.first);
    Quaterniond start;
    for (Index i = 0; i < count; ++i) {
      const FlightPose& pose = log.poses[stretch.first + static_cast<std::size_t>(i)];
      const Quaterniond begun = pose.q_ned_from_frd * turned.at(pose.time_s - x[0]).conjugate();
      if (i == 0) start = begun;
      const Vector3d apart = plant::rotation_vector(start.conjugate() * begun);
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

PoseTiming find_pose_timing(const FlightLog& log, const std::vector<Rows>& stretches) {
  const std::vector<Poses> poses = poses_of(log, stretches);
  PoseTiming out;
  out.delay = {"delay.poses", "T_p", "s"};
  for (std::size_t i = 0; i < 3; ++i)
    out.gyro_offset[i] = {std::string("gyro_offset.") + "xyz"[i], std::string("b_w") + "xyz"[i], "rad/s"};
  if (poses.size() < kLeastStretches) return out;

  SeriesProblem problem;
  problem.start = VectorXd::Zero(4);
  problem.scale = Eigen::Vector4d(2e-3, 0.01, 0.01, 0.01);
  problem.low = Eigen::Vector4d(-kLongestDelayS, -1.0, -1.0, -1.0);
  problem.high = -problem.low;
  problem.stretch_count = poses.size();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t first = problem.stretches.size();
    for (std::size_t stretch = 0; stretch < poses.size(); ++stretch)
      problem.stretches.insert(problem.stretches.end(), poses[stretch].last - poses[stretch].first, stretch);
    problem.channels.push_back({first, problem.stretches.size() - first});
  }
  problem.residuals = [&](const VectorXd& x, VectorXd& at) { residuals(log, poses, x, at); };

  const SeriesFit fit = fit_series(problem);
  const double factor = interval_factor(fit.degrees_of_freedom);
  const auto tell = [&](Estimate& estimate, Index i) {
    estimate.value = fit.parameters[i];
    estimate.standard_error = fit.standard_error(i);
    estimate.half_width = factor * estimate.standard_error;
  };
  tell(out.delay, 0);
  for (std::size_t i = 0; i < 3; ++i) tell(out.gyro_offset[i], static_cast<Index>(i) + 1);
  out.told = fit.converged && out.delay.half_width < kToldS;
  return out;
}

}  // namespace swiftlet::identification
