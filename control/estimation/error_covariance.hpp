// Covariance of the error state of an error-state Kalman filter whose attitude error is taken in the world
// frame: J. Sola, "Quaternion kinematics for the error-state Kalman filter", 2017, arXiv:1711.02508, ch. 7,
// "The ESKF using global angular errors". Equation numbers are those of version 1 on arXiv.
//
// The error is (position, velocity, rotation vector, gyro bias, accelerometer bias), truth minus estimate:
// the first three in NED, the biases in FRD. The true attitude is rotation(error) * q_ned_from_frd. With R =
// R_ned_from_frd and f = R * (specific force - bias) the error obeys Sola's Eq. (295a)-(295c),
//   d position = velocity,  d velocity = -[f]x rotation - R accelerometer_bias - noise,
//   d rotation = -R gyro_bias - noise.
// Integrated over an interval T, exactly for constant f and R, this is
//
//       | I   T I   -[s]x    T/3 [s]x R   -T^2/2 R |   position
//       | 0    I    -[u]x    T/2 [u]x R      -T R  |   velocity
//   F = | 0    0      I        -T R            0   |   rotation
//       | 0    0      0          I             0   |   gyro bias
//       | 0    0      0          0             I   |   accelerometer bias
//
// with u the integral of f and s its second integral. With a world-frame error, R does not rotate position,
// velocity and rotation, and u and s are known from the nominal state. So the covariance P stays at the time
// of the last pose and is propagated to the next in one step, P <- F P F' + Q, not with each IMU sample.
//
// A pose measures z = H error + noise of covariance V (Sola's Eq. (272)-(276), 6.1, "Observation of the error
// state via filter correction"),
//
//   H = | I 0 0 0 0 |,   S = H P H' + V,   K = P H' S^-1,   error = K z,   P <- P - K S K'.
//       | 0 0 I 0 0 |
//
// The last equation is the symmetric form of (I - K H) P (Sola's footnote 26). It equals Joseph's form,
// (I - K H) P (I - K H)' + K V K', for this K, and no other K is used. V is far above the rounding error of
// H P H', so P stays positive definite (estimator_consistency_test.cpp tests both).
//
// With the Cholesky factor L of S = L L', W = L^-1 H P and w = L^-1 z, this is error = W' w and P <- P - W' W.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

constexpr int kErrorStates = 15;
using ErrorState = Eigen::Matrix<double, kErrorStates, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorStates, kErrorStates, Eigen::RowMajor>;

// An interval of the nominal path, short enough for one R and one mean of f: about 20 ms. Negative intervals
// run backwards.
struct ErrorInterval {
  double duration_s = 0.0;
  Eigen::Vector3d velocity_change = Eigen::Vector3d::Zero();  // m/s, integral of f: without gravity
  Eigen::Vector3d position_change =
      Eigen::Vector3d::Zero();  // m, its second integral: without gravity and first velocity
  Eigen::Matrix3d r_ned_from_frd = Eigen::Matrix3d::Identity();  // at its middle
};

// Variance that is added per second.
struct ErrorNoise {
  double velocity = 0.0;            // (m/s)^2/s, the square of the accelerometer's noise density
  double rotation = 0.0;            // rad^2/s
  double gyro_bias = 0.0;           // (rad/s)^2/s
  double accelerometer_bias = 0.0;  // (m/s^2)^2/s
};

// Measured pose minus estimated pose, both at the covariance's time.
struct PoseInnovation {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, NED
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rad, in NED
};

class ErrorCovariance {
 public:
  ErrorCovariance() { reset(ErrorState::Zero()); }

  // Sets a diagonal covariance from standard deviations.
  void reset(const ErrorState& standard_deviation);

  void advance(const ErrorInterval& interval, const ErrorNoise& noise);
  // Adds variance to position, velocity and rotation, for motion that was not measured.
  void add_motion(double position_variance, double velocity_variance, double rotation_variance);

  // The update of a pose. Valid until the covariance changes.
  class Update {
   public:
    // z' S^-1 z = w' w, chi-square of 6 degrees of freedom.
    double normalised_square() const { return normalised_square_; }
    const ErrorState& step() const { return step_; }  // K z = W' w

   private:
    friend class ErrorCovariance;
    Eigen::Matrix<double, 6, kErrorStates, Eigen::RowMajor> w_;  // W
    ErrorState step_;
    double normalised_square_ = 0.0;
  };
  Update compute_update(const PoseInnovation& innovation, double position_variance,
                        double rotation_variance) const;
  // Sets the covariance to that after the update.
  void apply_update(const Update& correction);

  ErrorState standard_deviation() const { return p_.diagonal().cwiseMax(0.0).cwiseSqrt(); }
  const ErrorMatrix& matrix() const { return p_; }

 private:
  ErrorMatrix p_;
};

// F error.
ErrorState advance(const ErrorInterval& interval, const ErrorState& error);

}  // namespace swiftlet::control
