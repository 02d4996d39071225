// Covariance of the error state of an error-state Kalman filter whose attitude error is taken in the world
// frame (Sola 2017, "Quaternion kinematics for the error-state Kalman filter", arXiv:1711.02508, ch. 7:
// globally-defined orientation errors).
//
// The error is (position, velocity, rotation vector, gyro bias, accelerometer bias), truth less estimate: the
// first three in NED, the biases in FRD; the true attitude is rotation(error) * q_ned_from_frd. With R =
// R_ned_from_frd and f = R * (specific force less bias) it moves by Sola's Eq. (300)-(302),
//   d position = velocity,  d velocity = -f x rotation - R accelerometer_bias - noise,
//   d rotation = -R gyro_bias - noise.
// With a world-frame error, R does not turn the transition of position, velocity and rotation: over an
// interval these see nothing of the path but the integrals of f, and those the nominal state knows already.
// So the covariance waits at the last pose and is brought to the next in one step, and not with each IMU
// sample.
#pragma once

#include <array>

#include <Eigen/Core>

namespace swiftlet::control {

constexpr int kErrorStates = 15;
using ErrorState = Eigen::Matrix<double, kErrorStates, 1>;

// An interval of the nominal path, short enough for one R and one mean of f: some 20 ms. Negative intervals
// run backwards.
struct ErrorInterval {
  double duration_s = 0.0;
  Eigen::Vector3d velocity_change = Eigen::Vector3d::Zero();  // m/s, integral of f: without gravity
  Eigen::Vector3d position_change =
      Eigen::Vector3d::Zero();  // m, its second integral: without gravity and first velocity
  Eigen::Matrix3d r_ned_from_frd = Eigen::Matrix3d::Identity();  // in its middle
};

// Variances that a second adds.
struct ErrorNoise {
  double velocity = 0.0;            // (m/s)^2/s, the square of the accelerometer's noise density
  double rotation = 0.0;            // rad^2/s
  double gyro_bias = 0.0;           // (rad/s)^2/s
  double accelerometer_bias = 0.0;  // (m/s^2)^2/s
};

// A measured pose less the estimated one, both at the covariance's time.
struct PoseInnovation {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, NED
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  // rad, in NED
};

class ErrorCovariance {
  // One column more than there are states, so that rows fill vector registers. Of no meaning here.
  using Row = Eigen::Array<double, kErrorStates + 1, 1>;

 public:
  ErrorCovariance() { reset(ErrorState::Zero()); }

  // Uncorrelated, from standard deviations.
  void reset(const ErrorState& standard_deviation);

  void advance(const ErrorInterval& interval, const ErrorNoise& noise);
  // Adds to the variances of position, velocity and rotation: for what was not measured.
  void add_motion(double position_variance, double velocity_variance, double rotation_variance);

  // What a pose says: the innovation's square, normalised by its covariance, and the gains behind it. Holds
  // until the covariance changes.
  class Correction {
   public:
    double normalised_square() const { return normalised_square_; }  // chi-square of 6 degrees of freedom
    ErrorState step() const;                                         // K * innovation

   private:
    friend class ErrorCovariance;
    static constexpr int kRows = 6;
    std::array<Row, kRows> rows_;  // see weigh()
    double normalised_square_ = 0.0;
  };
  Correction weigh(const PoseInnovation& innovation, double position_variance,
                   double rotation_variance) const;
  // The covariance after the correction has been made: P - K S K'.
  void reduce(const Correction& correction);

  ErrorState standard_deviation() const;
  Eigen::Matrix<double, kErrorStates, kErrorStates> matrix() const;

 private:
  template <int kFirst>
  void reduce_rows(const Correction& correction);

  std::array<Row, kErrorStates> p_;
};

// How an error moves over an interval: p_.advance() does it to both sides of the covariance.
ErrorState advance(const ErrorInterval& interval, const ErrorState& error);

}  // namespace swiftlet::control
