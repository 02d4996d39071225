// Inner loop and plant alone, from extreme attitudes.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::attitude_recovery_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSpan_s = 3.0;
constexpr double kLevel = 0.98;  // cosine of the tilt

class Tumble {
 public:
  explicit Tumble(AttitudeErrorKind error)
      : vehicle_(tests::kaylion()), effectiveness_(plant::effectiveness(vehicle_)), allocator_(vehicle_) {
    ControlSettings settings = io::load_control_settings(io::find_config("control/motor_lag.yaml"));
    settings.attitude.error = error;
    attitude_.emplace(vehicle_, settings.attitude, design(vehicle_, settings));
  }

  // Time in s until it stays level; kSpan_s if it never does.
  double time_to_level(const plant::VehicleState& start) const {
    plant::SimulationSettings air;
    air.ground.present = false;
    plant::PlantSimulation plant(vehicle_, air, 1, start);
    AttitudeReference level;
    level.heading = 0.5;
    double tilted_s = 0.0;
    while (plant.stamp_ns() < static_cast<std::int64_t>(kSpan_s * 1e9)) {
      const plant::TruthSample truth = plant.truth();
      const double cosine = (truth.q_ned_from_frd * Vector3d::UnitZ()).z();
      if (cosine < kLevel) tilted_s = static_cast<double>(truth.stamp_ns) * 1e-9;
      Wrench wrench;
      wrench.thrust_n = vehicle_.mass_kg * plant::kGravity * std::max(cosine, 0.0);
      wrench.moment_frd =
          attitude_->moments(truth.q_ned_from_frd, truth.body_rates_frd, moment(truth), level);
      plant.step({plant::RotorState::kRunning,
                  allocator_.allocate(wrench, allocator_.supply_at(truth.supply_voltage_v)).throttle});
    }
    return tilted_s;
  }

 private:
  Vector3d moment(const plant::TruthSample& truth) const {
    Vector3d sum = Vector3d::Zero();
    for (int i = 0; i < truth.rotor_count; ++i) {
      const double speed = truth.rotor_speeds[static_cast<std::size_t>(i)];
      sum += vehicle_.rotor.thrust * speed * speed * effectiveness_.col(i).tail<3>();
    }
    return sum;
  }

  plant::Vehicle vehicle_;
  plant::Effectiveness effectiveness_;
  Allocator allocator_;
  std::optional<AttitudeController> attitude_;
};

plant::VehicleState start_at(const Quaterniond& q, const Vector3d& rates) {
  plant::VehicleState state;
  state.q_ned_from_frd = q;
  state.body_rates_frd = rates;
  for (int i = 0; i < tests::kaylion().rotor_count(); ++i)
    state.rotor_speeds[static_cast<std::size_t>(i)] = plant::hover_speed(tests::kaylion());
  return state;
}

TEST(AttitudeRecovery, RecoversFromUpsideDown) {
  const Tumble rotation(AttitudeErrorKind::kRotation);
  EXPECT_LT(rotation.time_to_level(start_at(Quaterniond(0, 1, 0, 0), Vector3d::Zero())), 1.0);
  EXPECT_LT(rotation.time_to_level(start_at(Quaterniond(0, 0, 1, 0), Vector3d::Zero())), 1.0);
}

TEST(AttitudeRecovery, RecoversFasterThanWithEulerAngles) {
  const Tumble rotation(AttitudeErrorKind::kRotation);
  const Tumble euler(AttitudeErrorKind::kEulerAngles);
  std::mt19937 generator(3);
  std::normal_distribution<double> draw;
  double rotation_s = 0.0;
  double euler_s = 0.0;
  for (int trial = 0; trial < 200; ++trial) {
    const Quaterniond q(draw(generator), draw(generator), draw(generator), draw(generator));
    const Vector3d rates = 3.0 * Vector3d(draw(generator), draw(generator), draw(generator));
    const plant::VehicleState start = start_at(q.normalized(), rates);
    const double taken_s = rotation.time_to_level(start);
    EXPECT_LT(taken_s, 1.5) << "trial " << trial;
    rotation_s += taken_s;
    euler_s += euler.time_to_level(start);
  }
  EXPECT_LT(rotation_s, euler_s);
}

}  // namespace swiftlet::control::attitude_recovery_test
