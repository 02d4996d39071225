// The path of a vehicle in a hand: guided motions one after the other, smooth and with rest between them.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/ground/vehicle_check/hand_motion.hpp"

namespace swiftlet::tests {

struct HandPose {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

class HandPath {
 public:
  explicit HandPath(const HandPose& start) : start_(start) {}

  // Appends the motion of a step. It begins at begin_s, which must not be before the end of the last one. Returns its end.
  double move(ground::HandStep step, double begin_s);

  HandPose at(double time_s) const;
  Eigen::Vector3d body_rates_frd(double time_s) const;
  Eigen::Vector3d specific_force_frd(double time_s) const;

 private:
  struct Motion {
    double begin_s = 0.0;
    double duration_s = 0.0;
    bool waves = false;
    HandPose from;
    Eigen::Vector3d moved_ned = Eigen::Vector3d::Zero();
    Eigen::Vector3d turned_frd = Eigen::Vector3d::Zero();  // rotation vector

    HandPose at(double time_s) const;
  };

  HandPose start_;
  std::vector<Motion> motions_;
};

}  // namespace swiftlet::tests
