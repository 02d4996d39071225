#include "swiftlet/control/estimation/moment_observer.hpp"

#include <Eigen/Geometry>

namespace swiftlet::control {

void MomentObserver::step(double dt_s, double bandwidth, const Eigen::Vector3d& body_rates_frd,
                          const Eigen::Vector3d& moment_frd) {
  if (!(bandwidth > 0.0)) return reset();
  const Eigen::Vector3d explained = moment_frd - body_rates_frd.cross(inertia_ * body_rates_frd);
  if (!body_rates_frd.allFinite() || !explained.allFinite()) return;
  if (!begun_) {
    begun_ = true;
    rates_ = moment_ = {};
    rates_.value = body_rates_frd;
    moment_.value = explained;
  }
  rates_.step(dt_s, bandwidth, body_rates_frd);
  moment_.step(dt_s, bandwidth, explained);
}

Eigen::Vector3d MomentObserver::moment_frd() const {
  if (!begun_) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d moment = inertia_ * rates_.rate - moment_.value;
  return moment.cwiseMax(-limit_frd_).cwiseMin(limit_frd_);
}

}  // namespace swiftlet::control
