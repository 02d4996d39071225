#include "swiftlet/control/estimation/moment_observer.hpp"

#include <Eigen/Geometry>

namespace swiftlet::control {

void MomentObserver::step(double dt_s, double bandwidth, const Eigen::Vector3d& body_rates_frd,
                          const Eigen::Vector3d& moment_frd) {
  const Eigen::Vector3d explained = moment_frd - body_rates_frd.cross(inertia_ * body_rates_frd);
  if (!body_rates_frd.allFinite() || !explained.allFinite()) return;
  if (!begun_) {
    begun_ = true;
    rates_ = {body_rates_frd, Eigen::Vector3d::Zero()};
    moment_ = {explained, Eigen::Vector3d::Zero()};
  }
  rates_.step(dt_s, bandwidth, body_rates_frd);
  moment_.step(dt_s, bandwidth, explained);
}

Eigen::Vector3d MomentObserver::moment_frd() const {
  if (!begun_) return Eigen::Vector3d::Zero();
  return inertia_ * rates_.rate - moment_.value;
}

}  // namespace swiftlet::control
