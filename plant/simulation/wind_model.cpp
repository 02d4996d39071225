#include "swiftlet/plant/simulation/wind_model.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {
namespace {

constexpr double kFoot_m = 0.3048;

// exp(-dt / tau) to third order. std::exp is not used: its last bits differ between processors.
double decay(double step_s, double time_s) {
  return (1.0 - 0.5 * step_s / time_s) / (1.0 + 0.5 * step_s / time_s);
}

// x^1.2 for x > 0, by Newton's method on y^5 = x^6. std::pow is not used either.
double power_1_2(double x) {
  const double x_6 = x * x * x * x * x * x;
  double y = x;
  for (int i = 0; i < 60; ++i) y -= (y - x_6 / (y * y * y * y)) / 5.0;
  return y;
}

Eigen::Array3d decays(const AirSettings& settings, double step_s) {
  const bool dryden = settings.dryden.height_m > 0.0;
  const Eigen::Vector3d times_s =
      dryden ? dryden_times_s(settings.dryden)
             : Eigen::Vector3d(Eigen::Vector3d::Constant(settings.gust_time_constant_s));
  return {decay(step_s, times_s.x()), decay(step_s, times_s.y()), decay(step_s, times_s.z())};
}

Eigen::Vector2d direction(const Eigen::Vector3d& wind_ned) {
  const double speed = wind_ned.head<2>().norm();
  return speed > 0.0 ? Eigen::Vector2d(wind_ned.head<2>() / speed)
                     : Eigen::Vector2d(Eigen::Vector2d::UnitX());
}

}  // namespace

Eigen::Vector3d dryden_times_s(const DrydenSettings& settings) {
  const double height_ft = settings.height_m / kFoot_m;
  const double horizontal_ft = height_ft / power_1_2(0.177 + 0.000823 * height_ft);
  return Eigen::Vector3d(horizontal_ft, horizontal_ft, height_ft) * kFoot_m / settings.airspeed_m_s;
}

WindModel::WindModel(const AirSettings& settings, double step_s, std::uint64_t seed)
    : gusty_(!settings.gust_sigma_ned.isZero(0.0)),
      dryden_(settings.dryden.height_m > 0.0),
      mean_ned_(settings.wind_ned),
      sigma_ned_(settings.gust_sigma_ned),
      decay_(decays(settings, step_s)),
      noise_gain_((1.0 - decay_ * decay_).sqrt()),
      gust_(Eigen::Vector3d::Zero()),
      lagged_(Eigen::Vector3d::Zero()),
      along_(direction(settings.wind_ned)),
      wind_ned_(settings.wind_ned),
      random_(seed, streams::kGusts) {
  if (!gusty_) return;
  gust_ = random_.normal3();
  // In the steady state lagged_ has half the variance of gust_ and a covariance of half with it.
  if (dryden_) lagged_ = 0.5 * (gust_ + random_.normal3());
  update();
}

void WindModel::draw() {
  lagged_ += ((1.0 - decay_) * (gust_ - lagged_).array()).matrix();
  gust_ = (decay_ * gust_.array() + noise_gain_ * random_.normal3().array()).matrix();
  update();
}

// Across and vertically, with T the correlation time, (1 + sqrt(3) T s) / (1 + T s)^2 is sqrt(3) / (1 + T s) +
// (1 - sqrt(3)) / (1 + T s)^2. Its variance is twice that of the first lag.
void WindModel::update() {
  Eigen::Vector3d gust = gust_;
  if (dryden_) {
    const double root_3 = std::sqrt(3.0);
    const Eigen::Vector3d second = std::sqrt(0.5) * (root_3 * gust_ + (1.0 - root_3) * lagged_);
    gust = {along_.x() * gust_.x() - along_.y() * second.y(),
            along_.y() * gust_.x() + along_.x() * second.y(), second.z()};
  }
  wind_ned_ = mean_ned_ + sigma_ned_.cwiseProduct(gust);
}

}  // namespace swiftlet::plant
