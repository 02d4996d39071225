#include "swiftlet/plant/simulation/wind_model.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

WindModel::WindModel(const AirSettings& settings, double step_s, std::uint64_t seed)
    : gusty_(!settings.gust_sigma_ned.isZero(0.0)),
      mean_ned_(settings.wind_ned),
      sigma_ned_(settings.gust_sigma_ned),
      // exp(-dt / tau) to third order. std::exp is not used: its last bits differ between processors.
      decay_((1.0 - 0.5 * step_s / settings.gust_time_constant_s) /
             (1.0 + 0.5 * step_s / settings.gust_time_constant_s)),
      noise_gain_(std::sqrt(1.0 - decay_ * decay_)),
      gust_(Eigen::Vector3d::Zero()),
      wind_ned_(settings.wind_ned),
      random_(seed, streams::kGusts) {
  if (!gusty_) return;
  gust_ = random_.normal3();
  wind_ned_ = mean_ned_ + sigma_ned_.cwiseProduct(gust_);
}

void WindModel::draw() {
  gust_ = decay_ * gust_ + noise_gain_ * random_.normal3();
  wind_ned_ = mean_ned_ + sigma_ned_.cwiseProduct(gust_);
}

}  // namespace swiftlet::plant
