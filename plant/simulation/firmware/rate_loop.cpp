#include "swiftlet/plant/simulation/firmware/rate_loop.hpp"

namespace swiftlet::plant {

Eigen::Vector3d RateLoop::step(const Eigen::Vector3d& wanted_rates, const Eigen::Vector3d& measured_rates,
                               double dt_s, bool integrate) {
  if (has_last_) {
    const double share = gains_.derivative_cutoff * dt_s / (1.0 + gains_.derivative_cutoff * dt_s);
    derivative_ += share * ((measured_rates - last_rates_) / dt_s - derivative_);
  }
  last_rates_ = measured_rates;
  has_last_ = true;
  const Eigen::Vector3d error = wanted_rates - measured_rates;
  if (integrate) {
    integral_ += dt_s * gains_.i.cwiseProduct(error);
    integral_ = integral_.cwiseMax(-gains_.integral_limit).cwiseMin(gains_.integral_limit);
  }
  const Eigen::Vector3d acceleration =
      gains_.p.cwiseProduct(error) + integral_ - gains_.d.cwiseProduct(derivative_);
  return inertia_.cwiseProduct(acceleration);
}

void RateLoop::reset() {
  integral_.setZero();
  derivative_.setZero();
  has_last_ = false;
}

}  // namespace swiftlet::plant
