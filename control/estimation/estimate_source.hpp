// Which estimate a vehicle is flown by that brings one of its own (vehicle_odometry): that of the estimator, which corrects
// the vehicle's motion by motion capture, or the vehicle's own. The settings choose; docs/vehicle.md has their meaning.
//
// The estimate never jumps with the source or with a jump of the vehicle's own: it goes on from where it was, and then glides
// to the new one no faster than the settings allow. A jump is no motion, so the velocity does not change with it.
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

class EstimateSource {
 public:
  // mocap_timeout_s: of the failsafe. With OdometryUse::kBoth the vehicle's own estimate takes over when no pose was used for
  // half of it, and motion capture again after kSteady_s of poses; one that fuses the poses of motion capture never does.
  EstimateSource(const OdometrySettings& settings, double mocap_timeout_s);

  // Chooses and forms the estimate at the stamp of the sample, to which `filter` has been propagated. specific_force_frd: of
  // the motion since the last sample, m/s^2. Call for each usable sample.
  void update(const plant::OdometrySample& sample, const Eigen::Vector3d& specific_force_frd,
              const Estimator& filter, plant::RotorState rotors);

  bool is_vehicles() const { return source_ == Source::kVehicle; }
  // There is an estimate; before that it has no meaning.
  bool initialised() const { return has_estimate_; }
  const Estimate& estimate() const { return now_; }
  // Since the source in force was last corrected: by a pose, or by a sample with a position, which must have had a pose
  // likewise if it fuses those of motion capture. s; infinite before the first.
  double position_age_s() const { return position_age_s_; }
  ErrorState standard_deviation(const Estimator& filter) const;

  // The vehicle's own estimate from that of motion capture; -1: one of both is missing.
  double distance_m() const { return distance_m_; }
  double angle_rad() const { return angle_rad_; }
  // Jumps of the vehicle's own estimate since the first sample.
  std::uint32_t resets_followed() const { return resets_followed_; }

  // From the frame of this estimate to that of the vehicle, in which it controls attitude and position.
  double heading_to_vehicle_rad() const { return heading_to_vehicle_rad_; }
  Eigen::Vector3d position_in_vehicle(const Eigen::Vector3d& position_ned) const;

  static constexpr double kSteady_s = 0.5;

 private:
  enum class Source : std::uint8_t { kMocap, kVehicle };
  struct Motion {  // of one source
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  };

  Source choose(const plant::OdometrySample& sample, const Estimator& filter, plant::RotorState rotors);
  double age_of_vehicle_s(const plant::OdometrySample& sample, const Estimator& filter) const;
  Motion motion_of_vehicle(const plant::OdometrySample& sample, const Eigen::Vector3d& specific_force_frd,
                           double dt_s) const;
  void go_on(const Motion& source, const Eigen::Vector3d& specific_force_frd, bool jumped, double dt_s);
  void glide(const Motion& source, bool settles_at_once, double dt_s);
  void compare(const plant::OdometrySample& sample, const Estimator& filter);

  OdometrySettings settings_;
  double lost_after_s_;
  Source source_ = Source::kMocap;
  bool has_estimate_ = false;
  bool has_sample_ = false;
  plant::OdometrySample sample_;                                 // the last one
  Motion last_;                                                  // of the source in force
  double heading_rad_ = 0.0;                                     // of this estimate from the source in force
  Eigen::Vector3d velocity_rest_ned_ = Eigen::Vector3d::Zero();  // likewise, m/s
  std::int64_t steady_since_ns_ = -1;
  std::int64_t valid_ns_ = -1;  // the last sample with a position
  std::uint32_t filter_resets_ = 0;
  std::uint32_t resets_followed_ = 0;
  double position_age_s_;
  double distance_m_ = -1.0;
  double angle_rad_ = -1.0;
  double heading_to_vehicle_rad_ = 0.0;
  Estimate now_;
};

}  // namespace swiftlet::control
