#include "swiftlet/control/estimation/lift_observer.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

void LiftObserver::update(double dt_s, double measured, double lift, double time_s) {
  const double part = dt_s / (time_s + dt_s);
  measured_ += part * (measured - measured_);
  modelled_ += part * (lift - modelled_);
}

void LiftObserver::step_on_ground(double dt_s, const Eigen::Vector3d& specific_force_frd,
                                  const Eigen::Quaterniond& q_ned_from_frd, double lift) {
  if (!specific_force_frd.allFinite() || !std::isfinite(lift)) return;
  if (!begun_) {
    begun_ = true;
    measured_ = -specific_force_frd.z();
    modelled_ = lift;
  }
  update(dt_s, -specific_force_frd.z(), lift, kOnset_s);
  const double upward = -(q_ned_from_frd * specific_force_frd).z() - plant::kGravity;
  // The mean keeps part / (2 - part) of the variance of white noise, and the innovation has 2 / (2 - part) of it.
  // Vibration rises with the lift.
  const double part = dt_s / (kOnset_s + dt_s);
  const double of_noise = dt_s / (ground_s_ + dt_s);
  const double innovation = upward - upward_;
  innovation_ += of_noise * (innovation * innovation - innovation_);
  squared_lift_ += of_noise * (lift * lift - squared_lift_);
  ground_s_ = std::min(ground_s_ + dt_s, kNoise_s);
  upward_ += part * innovation;
  if (modelled_ < kLeastLift) return;
  const double noise = lift * std::sqrt(0.5 * part * innovation_ / squared_lift_);
  if (upward_ < std::max(kLiftOff, kSure * noise)) return;
  lifted_off_ = true;
  ratio_ = std::clamp(measured_ / modelled_, kLeast, kMost);
}

void LiftObserver::step_in_flight(double dt_s, const Eigen::Vector3d& specific_force_frd, double lift) {
  if (!specific_force_frd.allFinite() || !std::isfinite(lift)) return;
  if (!lifted_off_) adopt(1.0);
  if (!begun_) {
    begun_ = true;
    measured_ = ratio_ * lift;
    modelled_ = lift;
  }
  update(dt_s, -specific_force_frd.z(), lift, time_s_);
  time_s_ = std::min(time_s_ + dt_s, kMemory_s);
  if (modelled_ < kLeastLift) return;
  ratio_ = std::clamp(measured_ / modelled_, kLeast, kMost);
}

void LiftObserver::adopt(double ratio) {
  lifted_off_ = true;
  begun_ = false;
  ratio_ = std::clamp(ratio, kLeast, kMost);
  time_s_ = kMemory_s;
}

}  // namespace swiftlet::control
