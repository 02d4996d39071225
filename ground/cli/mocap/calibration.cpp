#include "swiftlet/ground/cli/mocap/calibration.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <fmt/core.h>

#include "swiftlet/io/edit_yaml.hpp"
#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::size_t kLeastPoses = 20;

void require_enough(const BodyPoses& poses) {
  if (poses.size() < kLeastPoses)
    throw std::runtime_error(
        fmt::format("only {} tracked poses arrived, {} are needed", poses.size(), kLeastPoses));
}

// By how much the squares of standard deviations grow because the errors of neighbouring poses are alike.
double correlation(std::size_t poses, double seconds) {
  return std::max(1.0, static_cast<double>(poses) * kHandTime_s / seconds);
}

// The mean rotation, from the first on: iterates the mean of the rotation vectors.
Quaterniond mean_of(const BodyPoses& poses) {
  Quaterniond mean = poses.front().q_ned_from_frd;
  for (int iteration = 0; iteration < 3; ++iteration) {
    Vector3d sum = Vector3d::Zero();
    for (const mocap::NedPose& pose : poses)
      sum += math::rotation_vector(mean.conjugate() * pose.q_ned_from_frd);
    mean = (mean * math::rotation(sum / static_cast<double>(poses.size()))).normalized();
  }
  return mean;
}

std::string number_text(double number) { return fmt::format("{:.6g}", number); }

}  // namespace

Misalignment misalignment_of(const BodyPoses& poses, double seconds) {
  require_enough(poses);
  const Quaterniond mean = mean_of(poses);
  const auto count = static_cast<double>(poses.size());
  Vector3d centre = Vector3d::Zero();
  for (const mocap::NedPose& pose : poses) centre += pose.position_ned / count;
  Vector3d variance = Vector3d::Zero();
  double scatter_m2 = 0.0;
  for (const mocap::NedPose& pose : poses) {
    variance += math::rotation_vector(mean.conjugate() * pose.q_ned_from_frd).cwiseAbs2() / (count - 1.0);
    scatter_m2 += (pose.position_ned - centre).squaredNorm() / count;
  }
  if (scatter_m2 > kRestM * kRestM || variance.sum() > kRestRad * kRestRad)
    throw std::runtime_error(fmt::format(
        "the vehicle did not stand still: it moved by {:.1f} mm and {:.1f} mrad RMS, at most {:.0f} mm and "
        "{:.0f} mrad are allowed",
        1e3 * std::sqrt(scatter_m2), 1e3 * std::sqrt(variance.sum()), 1e3 * kRestM, 1e3 * kRestRad));
  Misalignment misalignment;
  misalignment.vector = math::rotation_vector(mean.conjugate());
  misalignment.deviation = (variance * correlation(poses.size(), seconds) / count).cwiseSqrt();
  return misalignment;
}

LeverArm lever_arm_of(const BodyPoses& poses, const Misalignment& misalignment, double seconds) {
  require_enough(poses);
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Quaterniond turn = math::rotation(misalignment.vector);
  Matrix6 normal = Matrix6::Zero();
  Vector6 right = Vector6::Zero();
  for (const mocap::NedPose& pose : poses) {
    Eigen::Matrix<double, 3, 6> row;
    row << (pose.q_ned_from_frd * turn).toRotationMatrix(), -Matrix3d::Identity();
    normal += row.transpose() * row;
    right -= row.transpose() * pose.position_ned;
  }
  const auto count = static_cast<double>(poses.size());
  const Eigen::LDLT<Matrix6> solver(normal);
  // The smallest pivot is the turn about the axis that was turned least, in squares of the sine.
  if (solver.vectorD().minCoeff() < 1e-3 * count)
    throw std::runtime_error(
        "the vehicle was turned too little: turn it by 30 degrees and more about two axes");
  const Vector6 solution = solver.solve(right);
  double squares = 0.0;
  for (const mocap::NedPose& pose : poses) {
    const Vector3d centre = pose.position_ned + (pose.q_ned_from_frd * turn) * solution.head<3>();
    squares += (centre - solution.tail<3>()).squaredNorm();
  }
  const double variance = squares / (3.0 * count - 6.0) * correlation(poses.size(), seconds);
  LeverArm arm;
  arm.frd = solution.head<3>();
  arm.deviation = (variance * solver.solve(Matrix6::Identity()).diagonal().head<3>()).cwiseSqrt();
  arm.residual_m = std::sqrt(squares / count);
  if (arm.deviation.maxCoeff() > kLargestDeviationM)
    throw std::runtime_error(
        fmt::format("the lever arm is known to {:.1f} mm only, {:.0f} mm are needed: the centre moved by "
                    "{:.1f} mm RMS; hold it better or turn longer",
                    1e3 * arm.deviation.maxCoeff(), 1e3 * kLargestDeviationM, 1e3 * arm.residual_m));
  if (arm.frd.cwiseAbs().maxCoeff() > mocap::kLongestLeverArmM)
    throw std::runtime_error(fmt::format("the lever arm is {:.2f} m long, at most {:g} m are allowed",
                                         arm.frd.norm(), mocap::kLongestLeverArmM));
  return arm;
}

std::string with_calibration(const std::string& text, const std::string& file_name,
                             const std::string& vehicle, const Misalignment& misalignment,
                             const LeverArm& lever_arm) {
  std::vector<std::pair<std::string, std::string>> values;
  for (int i = 0; i < 3; ++i) {
    const std::string index = "[" + std::to_string(i) + "]";
    values.emplace_back("vehicles." + vehicle + ".lever_arm_frd_m" + index, number_text(lever_arm.frd[i]));
    values.emplace_back("vehicles." + vehicle + ".misalignment_rad" + index,
                        number_text(misalignment.vector[i]));
  }
  return io::with_scalars(text, file_name, values);
}

}  // namespace swiftlet::ground
