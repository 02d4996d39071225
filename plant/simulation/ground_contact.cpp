#include "swiftlet/plant/simulation/ground_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet::plant {

namespace {

constexpr int kMaxSweeps = 60;
constexpr double kConverged = 1.0e-7;  // m/s, change of a point's velocity in one sweep
constexpr double kRest = 1.0e-5;       // m/s; a body in contact that is slower than this is set to rest

Eigen::Quaterniond integrate_attitude(const Eigen::Quaterniond& q, const Eigen::Vector3d& body_rates_frd,
                                      double dt) {
  const Eigen::Vector3d half = 0.5 * dt * body_rates_frd;
  return (q * Eigen::Quaterniond(1.0, half.x(), half.y(), half.z())).normalized();
}

}  // namespace

GroundContact::GroundContact(const Vehicle& vehicle, const GroundSettings& settings)
    : present_(settings.present),
      floor_z_(settings.leg_height_m),
      friction_(settings.friction),
      mass_(vehicle.mass_kg),
      inverse_inertia_(vehicle.inertia.inverse()),
      point_count_(2 * vehicle.rotor_count()) {
  for (int i = 0; i < vehicle.rotor_count(); ++i) {
    const auto rotor = static_cast<std::size_t>(i);
    const Eigen::Vector3d& hub = vehicle.rotors[rotor].position_frd;
    points_frd_[2 * rotor] = {hub.x(), hub.y(), settings.leg_height_m};
    points_frd_[2 * rotor + 1] = hub;
    reach_ = std::max({reach_, points_frd_[2 * rotor].norm(), hub.norm()});
  }
  for (Point& point : points_) point.impulse.setZero();
  if (!present_) reach_ = -std::numeric_limits<double>::infinity();
}

double GroundContact::clearance(const VehicleState& state) const {
  double lowest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < point_count_; ++i) {
    const Eigen::Vector3d arm = state.q_ned_from_frd * points_frd_[static_cast<std::size_t>(i)];
    lowest = std::max(lowest, arm.z());
  }
  return floor_z_ - state.position_ned.z() - lowest;
}

bool GroundContact::resolve(const ContactState& before, VehicleState& after, double dt,
                            Eigen::Vector3d& acceleration_ned) {
  const auto count = static_cast<std::size_t>(point_count_);
  const Eigen::Matrix3d rotation = before.q_ned_from_frd.toRotationMatrix();
  Eigen::Vector3d velocity = after.velocity_ned;
  Eigen::Vector3d turn_rate = rotation * after.body_rates_frd;  // in NED

  // Uses the geometry at the start of the step. A point that stays above the floor without an impulse carries
  // no load.
  bool touching = false;
  for (std::size_t i = 0; i < count; ++i) {
    Point& point = points_[i];
    point.arm_ned = rotation * points_frd_[i];
    point.has_inertia = false;
    point.gap = std::max(floor_z_ - before.position_ned.z() - point.arm_ned.z(), 0.0);
    touching = touching || dt * (velocity + turn_rate.cross(point.arm_ned)).z() > point.gap;
  }
  if (!touching) {
    for (std::size_t i = 0; i < count; ++i) points_[i].impulse.setZero();
    return false;
  }

  const Eigen::Matrix3d inverse_inertia_ned = rotation * inverse_inertia_ * rotation.transpose();
  const auto apply = [&](const Point& point, const Eigen::Vector3d& impulse) {
    velocity += impulse / mass_;
    turn_rate += point.turn * impulse;
  };
  const auto find_inertia = [&](Point& point) {
    Eigen::Matrix3d cross;  // arm x
    cross << 0.0, -point.arm_ned.z(), point.arm_ned.y(), point.arm_ned.z(), 0.0, -point.arm_ned.x(),
        -point.arm_ned.y(), point.arm_ned.x(), 0.0;
    point.turn = inverse_inertia_ned * cross;
    point.inverse_mass = (-cross * point.turn).diagonal().array() + 1.0 / mass_;
    point.has_inertia = true;
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (points_[i].impulse.z() == 0.0) continue;
    find_inertia(points_[i]);
    apply(points_[i], points_[i].impulse);
  }

  double change = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < kMaxSweeps && change > kConverged; ++sweep) {
    change = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      Point& point = points_[i];
      const Eigen::Vector3d old = point.impulse;
      // z points down: a point may move down by at most gap / dt, and its impulse only pushes up.
      const double excess = (velocity + turn_rate.cross(point.arm_ned)).z() - point.gap / dt;
      if (excess <= 0.0 && old.z() == 0.0) continue;  // no impulse needed, none applied
      if (!point.has_inertia) find_inertia(point);
      point.impulse.z() = std::min(old.z() - excess / point.inverse_mass.z(), 0.0);
      apply(point, {0.0, 0.0, point.impulse.z() - old.z()});

      const Eigen::Vector3d slip = velocity + turn_rate.cross(point.arm_ned);
      const double x = old.x() - slip.x() / point.inverse_mass.x();
      const double y = old.y() - slip.y() / point.inverse_mass.y();
      const double limit = -friction_ * point.impulse.z();
      const double size = std::sqrt(x * x + y * y);
      const double scale = size > limit ? limit / size : 1.0;
      point.impulse.x() = scale * x;
      point.impulse.y() = scale * y;
      apply(point, {point.impulse.x() - old.x(), point.impulse.y() - old.y(), 0.0});
      change = std::max(change, (point.impulse - old).cwiseAbs().maxCoeff() / mass_);
    }
  }

  bool bears = false;
  for (std::size_t i = 0; i < count; ++i) bears = bears || points_[i].impulse.z() < 0.0;
  if (!bears) return false;

  const bool rests = velocity.norm() < kRest && turn_rate.norm() * reach_ < kRest;
  if (rests) {
    velocity.setZero();
    turn_rate.setZero();
  }
  acceleration_ned = (velocity - after.velocity_ned) / dt;
  after.velocity_ned = velocity;
  after.body_rates_frd = rotation.transpose() * turn_rate;
  after.position_ned = before.position_ned + dt * velocity;
  after.q_ned_from_frd =
      rests ? before.q_ned_from_frd : integrate_attitude(before.q_ned_from_frd, after.body_rates_frd, dt);
  // Rotation moves points along arcs, so that they may end below the floor by a distance of order dt^2. The
  // body is lifted by that distance.
  if (!rests) after.position_ned.z() += std::min(clearance(after), 0.0);
  return true;
}

}  // namespace swiftlet::plant
