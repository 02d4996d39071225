#include "swiftlet/identification/mocap/body_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/identification/mocap/alignment_motion.hpp"
#include "swiftlet/identification/mocap/motion_recording.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Vector3d;
using namespace alignment;

constexpr int kFirstIterations = 3;  // with the noise assumed at first
constexpr int kConverged = 11;       // before, residuals of the IMU are those of the start
constexpr int kIterations = 15;
constexpr double kShortestStep = 1e-3;  // of the full one
constexpr double kCorrelation_s = 0.5;  // longest that errors of poses are alike
constexpr double kGate = 45.0;  // of squares of normalised residuals, 6 degrees of freedom: 1 of 1e7 poses
constexpr double kMostRefused = 0.05;
constexpr double kLeastPositionNoise_m = 2e-5;  // of a pose
constexpr double kMostPositionNoise_m = 5e-3;
constexpr double kLeastOrientationNoise_rad = 1e-4;
constexpr double kMostOrientationNoise_rad = 30e-3;
constexpr double kMostForceNoise = 0.04;  // m/s^2/sqrt(Hz)
constexpr double kMostRateNoise = 5e-3;   // rad/s/sqrt(Hz)
constexpr double kTurning_rad_s = 0.05;   // least RMS of the rates at which they tell the delay of the poses
constexpr double kKnownDelay_s = 1e-5;
constexpr std::size_t kLeastPoses = 50;
// The deviations are larger by this factor: the derivatives are those at a motion that is itself estimated, and its noise
// passes for motion. With it, the intervals of simulated flights hold the true values.
constexpr double kAllowance = 1.25;

// Least squares over all motion states and the parameters by Gauss-Newton. The normal equations are block-tridiagonal with the
// parameters as a border; the states are eliminated one after the other.
class AlignmentFit {
 public:
  AlignmentFit(const MotionRecording& recording, const AlignmentPriors& priors, const Noise& noise)
      : recording_(recording),
        least_(noise),
        noise_(noise),
        states_(recording.poses.size()),
        refused_(states_.size(), 0) {
    parameter_deviation_ << Vector3d::Constant(priors.misalignment_rad),
        Vector3d::Constant(priors.lever_arm_m), Eigen::Vector2d::Constant(priors.vertical_rad),
        priors.pose_delay_s;
    // Position, velocity and attitude of the first state are next to unknown.
    first_deviation_ << Vector3d::Constant(10.0), Vector3d::Constant(3.0), Vector3d::Constant(1.0),
        Vector3d::Constant(priors.accelerometer_bias_m_s2), Vector3d::Constant(priors.gyro_bias_rad_s);
    for (std::size_t k = 0; k < states_.size(); ++k) {
      State& state = states_[k];
      state.position = recording.poses[k].position_ned;
      state.attitude = recording.poses[k].q_ned_from_frd;
      const std::size_t next = std::min(k + 1, states_.size() - 1);
      const std::size_t last = k == 0 ? 0 : k - 1;
      state.velocity = (recording.poses[next].position_ned - recording.poses[last].position_ned) /
                       (recording.poses[next].time_s - recording.poses[last].time_s);
      state.force = recording.force[k];
      state.rates = recording.rates[k];
    }
    first_ = states_.front();
  }

  // The full step, or the longest part of it that lowers the cost: with a vehicle that hardly moves, lever arm and misalignment
  // are next to free, and a full step goes further than the derivatives hold.
  void iterate() {
    eliminate();
    const std::vector<Motion> steps = substituted();
    const double cost_before = cost();
    const std::vector<State> states = states_;
    const Sought sought = sought_;
    for (double part = 1.0; part > kShortestStep; part *= 0.5) {
      for (std::size_t k = 0; k < states.size(); ++k) {
        states_[k] = states[k];
        states_[k].add(part * steps[k]);
      }
      sought_ = sought;
      sought_.add(part * step_);
      if (cost() <= cost_before) return;
    }
    states_ = states;
    sought_ = sought;
  }

  // The noise of the poses from the residuals and the part of their variance that the fit took away, and which poses to refuse.
  void learn_pose_noise() {
    const Residual variances = noise_.variances();
    std::vector<Residual> residuals;
    Residual squares = Residual::Zero();
    MotionMatrix covariance;
    for (std::size_t k = states_.size(); k-- > 0;) {
      const Eliminated& one = eliminated_[k];
      covariance = k + 1 == states_.size()
                       ? one.inverse
                       : MotionMatrix(one.inverse + one.by_next * covariance * one.by_next.transpose());
      const Observation seen = observe(recording_.poses[k], states_[k], sought_);
      refused_[k] = (seen.residual.cwiseAbs2().cwiseQuotient(variances)).sum() > kGate ? 1 : 0;
      if (refused_[k] != 0) continue;
      residuals.push_back(seen.residual);
      squares +=
          seen.residual.cwiseAbs2() + (seen.by_motion * covariance * seen.by_motion.transpose()).diagonal();
    }
    if (residuals.size() < kLeastPoses) return;
    const auto count = 3.0 * static_cast<double>(residuals.size());
    noise_.position_m = std::max(kLeastPositionNoise_m, std::sqrt(squares.head<3>().sum() / count));
    noise_.orientation_rad = std::max(kLeastOrientationNoise_rad, std::sqrt(squares.tail<3>().sum() / count));
    const double period_s = (recording_.poses.back().time_s - recording_.poses.front().time_s) /
                            static_cast<double>(states_.size() - 1);
    noise_.position_growth = growth(residuals, 0, period_s);
    noise_.orientation_growth = growth(residuals, 3, period_s);
  }

  // The noise of the IMU from the residuals alone, at least as much as was assumed at first.
  void learn_imu_noise() {
    double force = 0.0;
    double rate = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k + 1 < states_.size(); ++k) {
      if (recording_.intervals[k].is_gap) continue;
      const Propagation step = propagate(states_[k], recording_.intervals[k], sought_, noise_);
      const Motion squares = states_[k + 1].minus(step.state).cwiseAbs2().cwiseQuotient(step.variance);
      force += squares.segment<3>(kVelocity).sum();
      rate += squares.segment<3>(kAttitude).sum();
      count += 3.0;
    }
    if (count == 0.0) return;
    noise_.force = std::max(least_.force, noise_.force * std::sqrt(force / count));
    noise_.rate = std::max(least_.rate, noise_.rate * std::sqrt(rate / count));
  }

  BodyAlignment result() const {
    BodyAlignment out;
    const Parameters deviation = kAllowance * covariance_.diagonal().cwiseMax(0.0).cwiseSqrt();
    out.misalignment = {math::rotation_vector(sought_.misalignment), deviation.segment<3>(kMisalignment)};
    out.lever_arm = {sought_.lever_arm, deviation.segment<3>(kLeverArm)};
    out.vertical = sought_.vertical;
    out.vertical_deviation = deviation.segment<2>(kVertical);
    out.pose_delay_s = sought_.delay_s;
    out.pose_delay_deviation_s = deviation[kDelay];
    out.force_noise = noise_.force;
    out.rate_noise = noise_.rate;
    out.position_noise_m = noise_.position_m;
    out.orientation_noise_rad = noise_.orientation_rad;
    out.duration_s = recording_.poses.back().time_s - recording_.poses.front().time_s;
    out.poses = states_.size();
    out.refused = static_cast<std::size_t>(std::count(refused_.begin(), refused_.end(), 1));
    return out;
  }

 private:
  // A state in terms of the next one and of the parameters: value - by_next * next - by_parameters * parameters.
  struct Eliminated {
    MotionMatrix inverse;
    MotionMatrix by_next = MotionMatrix::Zero();
    MotionParameters by_parameters;
    Motion value;
  };

  // Variance inflation of a mean of correlated values: 1 + 2 * the sum of the autocorrelations.
  static double growth(const std::vector<Residual>& residuals, int first, double period_s) {
    const auto product = [&](std::size_t lag) {
      double sum = 0.0;
      for (std::size_t i = lag; i < residuals.size(); ++i)
        sum += residuals[i].segment<3>(first).dot(residuals[i - lag].segment<3>(first));
      return sum;
    };
    const auto lags = std::min(residuals.size() / 4, static_cast<std::size_t>(kCorrelation_s / period_s));
    const double variance = std::max(product(0), 1e-30);
    double sum = 1.0;
    for (std::size_t lag = 1; lag <= lags; ++lag) sum += 2.0 * product(lag) / variance;
    return std::max(1.0, sum);
  }

  void eliminate() {
    eliminated_.resize(states_.size());
    ParameterMatrix C = parameter_deviation_.cwiseAbs2().cwiseInverse().asDiagonal();
    Parameters c = -parameter_deviation_.cwiseAbs2().cwiseInverse().cwiseProduct(sought_.vector());
    const Motion prior = first_deviation_.cwiseAbs2().cwiseInverse();
    MotionMatrix A = prior.asDiagonal();
    Motion a = prior.cwiseProduct(first_.minus(states_.front()));
    MotionParameters B = MotionParameters::Zero();
    const Residual weights = noise_.variances().cwiseInverse();
    for (std::size_t k = 0; k < states_.size(); ++k) {
      if (refused_[k] == 0) {
        const Observation seen = observe(recording_.poses[k], states_[k], sought_);
        const Eigen::Matrix<double, kMotion, 6> weighted = seen.by_motion.transpose() * weights.asDiagonal();
        A += weighted * seen.by_motion;
        B += weighted * seen.by_parameters;
        a += weighted * seen.residual;
        C += seen.by_parameters.transpose() * weights.asDiagonal() * seen.by_parameters;
        c += seen.by_parameters.transpose() * weights.asDiagonal() * seen.residual;
      }
      MotionMatrix to_next = MotionMatrix::Zero();
      MotionMatrix hessian_of_next = MotionMatrix::Zero();
      MotionParameters border_of_next = MotionParameters::Zero();
      Motion next_a = Motion::Zero();
      if (k + 1 < states_.size()) {
        const Propagation step = propagate(states_[k], recording_.intervals[k], sought_, noise_);
        const Motion weight = step.variance.cwiseInverse();
        const Motion off =
            step.state.minus(states_[k + 1]);  // = next error - F * error - by_vertical * vertical
        const MotionMatrix weighted = step.transition.transpose() * weight.asDiagonal();
        const Eigen::Matrix<double, kMotion, 2> weighted_vertical = weight.asDiagonal() * step.by_vertical;
        A += weighted * step.transition;
        a -= weighted * off;
        B.middleCols<2>(kVertical) += weighted * step.by_vertical;
        C.block<2, 2>(kVertical, kVertical) += step.by_vertical.transpose() * weighted_vertical;
        c.segment<2>(kVertical) -= weighted_vertical.transpose() * off;
        to_next = -weighted;
        hessian_of_next = weight.asDiagonal();
        next_a = weight.cwiseProduct(off);
        border_of_next.middleCols<2>(kVertical) = -weighted_vertical;
      }
      Eliminated& one = eliminated_[k];
      const Eigen::LLT<MotionMatrix> solver(A);
      one.inverse = solver.solve(MotionMatrix::Identity());
      one.by_next = solver.solve(to_next);
      one.by_parameters = solver.solve(B);
      one.value = solver.solve(a);
      C -= B.transpose() * one.by_parameters;
      c -= B.transpose() * one.value;
      A = hessian_of_next - to_next.transpose() * one.by_next;
      B = border_of_next - to_next.transpose() * one.by_parameters;
      a = next_a - to_next.transpose() * one.value;
    }
    const Eigen::LDLT<ParameterMatrix> solver(C);
    covariance_ = solver.solve(ParameterMatrix::Identity());
    step_ = solver.solve(c);
  }

  std::vector<Motion> substituted() const {
    std::vector<Motion> steps(states_.size());
    Motion next = Motion::Zero();
    for (std::size_t k = states_.size(); k-- > 0;) {
      const Eliminated& one = eliminated_[k];
      next = one.value - one.by_parameters * step_ - one.by_next * next;
      steps[k] = next;
    }
    return steps;
  }

  // Sum of squares of all normalised residuals: of poses, motion and what was known before.
  double cost() const {
    const Residual variances = noise_.variances();
    double sum = sought_.vector().cwiseQuotient(parameter_deviation_).squaredNorm() +
                 first_.minus(states_.front()).cwiseQuotient(first_deviation_).squaredNorm();
    for (std::size_t k = 0; k < states_.size(); ++k) {
      if (refused_[k] == 0)
        sum += observe(recording_.poses[k], states_[k], sought_)
                   .residual.cwiseAbs2()
                   .cwiseQuotient(variances)
                   .sum();
      if (k + 1 == states_.size()) break;
      const Propagation step = propagate(states_[k], recording_.intervals[k], sought_, noise_);
      sum += states_[k + 1].minus(step.state).cwiseAbs2().cwiseQuotient(step.variance).sum();
    }
    return sum;
  }

  const MotionRecording& recording_;
  const Noise least_;
  Noise noise_;
  Parameters parameter_deviation_;
  Motion first_deviation_;
  State first_;
  std::vector<State> states_;
  std::vector<char> refused_;
  Sought sought_;
  std::vector<Eliminated> eliminated_;
  ParameterMatrix covariance_ = ParameterMatrix::Zero();
  Parameters step_ = Parameters::Zero();
};

void require_rows(const FlightLog& log) {
  const double duration_s = log.size() < 3 ? 0.0 : log.time_s.back() - log.time_s.front();
  if (duration_s < kShortestAlignment_s)
    throw std::runtime_error(fmt::format("{:.1f} s of IMU samples are recorded, {:g} s are needed",
                                         duration_s, kShortestAlignment_s));
}

void require_poses(const MotionRecording& recording) {
  const double duration_s =
      recording.poses.empty() ? 0.0 : recording.poses.back().time_s - recording.poses.front().time_s;
  if (duration_s < kShortestAlignment_s || recording.poses.size() < kLeastPoses)
    throw std::runtime_error(
        fmt::format("{:.1f} s with {} poses and IMU samples are recorded, {:g} s and {} poses are needed",
                    duration_s, recording.poses.size(), kShortestAlignment_s, kLeastPoses));
}

void require_one_motion(const BodyAlignment& found) {
  if (static_cast<double>(found.refused) <= kMostRefused * static_cast<double>(found.poses) &&
      found.position_noise_m < kMostPositionNoise_m &&
      found.orientation_noise_rad < kMostOrientationNoise_rad && found.force_noise < kMostForceNoise &&
      found.rate_noise < kMostRateNoise)
    return;
  throw std::runtime_error(fmt::format(
      "IMU and poses do not show one motion: the poses are off by {:.1f} mm and {:.1f} mrad RMS and {} of {} "
      "by much "
      "more, the IMU by {:.2f} m/s^2 and {:.3f} rad/s; the body may be that of another vehicle, or the axes "
      "or units of "
      "one of them wrong ('swiftlet check vehicle --hand')",
      1e3 * found.position_noise_m, 1e3 * found.orientation_noise_rad, found.refused, found.poses,
      found.force_noise / std::sqrt(kShortestPoseInterval_s),
      found.rate_noise / std::sqrt(kShortestPoseInterval_s)));
}

}  // namespace

BodyAlignment align_body(const FlightLog& log, const AlignmentPriors& priors) {
  require_rows(log);
  const MotionRecording recording = recording_of(log);
  require_poses(recording);
  // In a calm hover the delay has no effect, and noise would pass for one.
  const bool tells_delay = recording.rms_rates() > kTurning_rad_s;
  AlignmentPriors used = priors;
  if (!tells_delay) used.pose_delay_s = kKnownDelay_s;
  Noise noise;
  noise.force = noise_density(log.time_s, log.specific_force_frd, kForceNoise);
  noise.rate = noise_density(log.time_s, log.body_rates_frd, kRateNoise);
  AlignmentFit fit(recording, used, noise);
  for (int i = 0; i < kIterations; ++i) {
    fit.iterate();
    if (i + 1 >= kFirstIterations && i + 1 < kIterations) fit.learn_pose_noise();
    if (i + 1 >= kConverged && i + 1 < kIterations) fit.learn_imu_noise();
  }
  BodyAlignment found = fit.result();
  if (!tells_delay) found.pose_delay_deviation_s = priors.pose_delay_s;
  require_one_motion(found);
  return found;
}

}  // namespace swiftlet::identification
