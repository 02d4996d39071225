// Compares what three axes show with what is expected of them, and finds the exchange or reversal of axes that explains a
// difference.
#pragma once

#include <Eigen/Core>

namespace swiftlet::control {

// Sums of products of inputs and of the response of three axes, over a window that forgets. A hypothesis is a matrix G, 3 x N:
// the response is G times the inputs.
template <int N>
class AxisResponse {
 public:
  using Inputs = Eigen::Matrix<double, N, 1>;
  using Gain = Eigen::Matrix<double, 3, N>;

  explicit AxisResponse(double memory_s) : memory_s_(memory_s) {}

  // floor: of the response, below which an axis shows nothing.
  void add(double dt_s, const Inputs& inputs, const Eigen::Vector3d& response, const Eigen::Vector3d& floor) {
    const double kept = memory_s_ / (memory_s_ + dt_s);
    floors_ = kept * (floors_ + dt_s * floor.cwiseAbs2());
    inputs_ = kept * (inputs_ + dt_s * inputs * inputs.transpose());
    products_ = kept * (products_ + dt_s * response * inputs.transpose());
    squares_ = kept * (squares_ + dt_s * response.cwiseAbs2());
  }

  // The input `constant` has an unknown effect: it explains what it can.
  void take_out(int constant) {
    const double square = inputs_(constant, constant);
    if (!(square > 0.0)) return;
    const Inputs with = inputs_.col(constant);
    const Eigen::Vector3d shown = products_.col(constant);
    inputs_ -= with * with.transpose() / square;
    products_ -= shown * with.transpose() / square;
    squares_ -= shown.cwiseAbs2() / square;
  }

  // 0: the axes show what the hypothesis expects; 1: nothing of it, or another signal; 2: the reverse.
  Eigen::Vector3d misfit(const Gain& gain) const {
    const Eigen::Vector3d expected = (gain * inputs_).cwiseProduct(gain).rowwise().sum();
    const Eigen::Vector3d both = gain.cwiseProduct(products_).rowwise().sum();
    const Eigen::Vector3d rest = (squares_ - 2.0 * both + expected).cwiseMax(0.0);
    const Eigen::Vector3d all = squares_ + expected;
    return rest.cwiseQuotient((all + floors_).cwiseMax(kTiny));
  }

  // True for each axis that shows something, or should by the hypothesis.
  Eigen::Array<bool, 3, 1> moves(const Gain& gain) const {
    const Eigen::Vector3d expected = (gain * inputs_).cwiseProduct(gain).rowwise().sum();
    return (squares_ + expected).array() > kMoves * floors_.array();
  }

 private:
  static constexpr double kTiny = 1e-12;
  static constexpr double kMoves = 3.0;

  double memory_s_;
  Eigen::Matrix<double, N, N> inputs_ = Eigen::Matrix<double, N, N>::Zero();
  Gain products_ = Gain::Zero();
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d floors_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::control
