// Settings of the simulation: integration, sensors, battery, air and ground. settings_visit.hpp has their keys in the
// simulation file and their limits.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/violation.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"

namespace swiftlet::plant {

// Noise densities are those of data sheets; a sample's standard deviation is density * sqrt(rate).
struct ImuSettings {
  double rate_hz = 500.0;                        // 1 s / rate must be a whole number of integration steps
  double accelerometer_noise_density = 4.0e-3;   // m/s^2/sqrt(Hz)
  double gyro_noise_density = 2.0e-4;            // rad/s/sqrt(Hz)
  double accelerometer_bias_sigma = 0.1;         // m/s^2, constant bias, drawn once per run for each axis
  double gyro_bias_sigma = 0.01;                 // rad/s, as above
  double accelerometer_bias_walk = 1.0e-3;       // m/s^2/sqrt(s), random walk of the bias: walk * sqrt(t)
  double gyro_bias_walk = 1.0e-4;                // rad/s/sqrt(s)
  double accelerometer_range = 16.0 * kGravity;  // m/s^2, samples saturate here
  double gyro_range = 34.9;                      // rad/s
};

enum class MocapModel {
  kBounded,    // constant frame rate, bounded errors: a calibrated system as its data sheet states
  kOptitrack,  // irregular frame intervals, Gaussian errors: recorded sessions of an OptiTrack system
};

struct MocapSettings {
  MocapModel model = MocapModel::kBounded;
  double rate_hz = 100.0;    // kBounded
  double latency_s = 0.010;  // from exposure to delivery
  // kBounded: radius of the ball that contains the error of each frame. kOptitrack: standard deviation of
  // each axis.
  double position_error_m = 1.0e-4;
  double orientation_error_rad = 1.4e-3;  // the same for the rotation vector: 0.1 mm over an arm of 69.5 mm
  // kOptitrack: quantiles of the frame interval at kIntervalProbabilities; uniform in between.
  static constexpr std::array<double, 11> kIntervalProbabilities = {0.0,  0.05, 0.10, 0.25,  0.50, 0.75,
                                                                    0.90, 0.95, 0.99, 0.999, 1.0};
  std::array<double, 11> interval_quantiles_s = {0.0003, 0.0012, 0.0097, 0.0100, 0.0199, 0.0203,
                                                 0.0300, 0.0301, 0.0400, 0.1300, 0.1400};
  double misalignment_rad = 1.75e-3;  // angle from marker body to vehicle axes; direction drawn once per run
  double dropout_probability = 0.0;   // probability that a frame begins a dropout
  double dropout_length_s = 0.2;      // duration of a dropout, in which frames are untracked
};

// Between the vehicle and the computers on the ground: its samples one way, commands and poses the other. Each packet takes
// delay_s and a uniform part of jitter_s. Without delay, jitter and loss there is no radio.
struct RadioSettings {
  double delay_s = 0.0;   // one way
  double jitter_s = 0.0;  // at most, in addition
  double loss = 0.0;      // probability that a packet is lost

  bool on() const { return delay_s > 0.0 || jitter_s > 0.0 || loss > 0.0; }
};

struct SupplySettings {
  bool ideal = false;                    // constant voltage: open circuit at the initial state of charge
  double initial_state_of_charge = 1.0;  // 0 .. 1
  double rate_hz = 10.0;  // of battery samples; 1 s / rate must be a whole number of integration steps
};

// Gusts by the Dryden model at low altitude (MIL-F-8785C, section 3.7.3.4; MIL-HDBK-1797). Turbulence of the
// lengths L_w = h vertically and L_u = L_v = h / (0.177 + 0.000823 h)^1.2 along and across the wind, h in feet,
// passes at the airspeed.
struct DrydenSettings {
  double height_m = 0.0;      // h; 0: gusts of the first order with gust_time_constant_s
  double airspeed_m_s = 1.0;  // > 0
};

struct AirSettings {
  bool drag = true;                                    // applies the vehicle's linear drag
  Eigen::Vector3d wind_ned = Eigen::Vector3d::Zero();  // m/s, steady
  Eigen::Vector3d gust_sigma_ned =
      Eigen::Vector3d::Zero();        // m/s, gusts: an Ornstein-Uhlenbeck process for each axis
  double gust_time_constant_s = 1.0;  // correlation time of the gusts
  DrydenSettings dryden;              // in place of these processes
  // N s^2/m: drag in the plane of the rotors for each rad/s of each of them, times the velocity relative to the
  // air (blade flapping and induced drag).
  double rotor_drag = 0.0;
};

// The floor is level, leg_height_m below z = 0 NED. A vehicle that stands level on it has its
// origin at z = 0.
struct GroundSettings {
  bool present = true;
  double leg_height_m = 0.02;          // from the body origin down to the feet, one under each rotor
  double friction = 0.6;               // Coulomb coefficient
  double effect_rotor_radius_m = 0.0;  // of the rotors in ground effect (dynamics.hpp); 0: none
};

// The place of the origin of NED on Earth, and its magnetic field, which is uniform. The default is in Zurich:
// declination 3.4 deg, inclination 63.2 deg, 0.482 gauss, by the World Magnetic Model 2025.
struct SiteSettings {
  double latitude_deg = 47.397742;
  double longitude_deg = 8.545594;
  double altitude_m = 488.0;                                   // above mean sea level
  Eigen::Vector3d magnetic_field_ned{0.2174, 0.0129, 0.4304};  // gauss
};

// The following sensors are simulated for an autopilot with an estimator of its own. Their samples are taken
// together with one of the IMU, whose rate therefore limits theirs.
struct BarometerSettings {
  double rate_hz = 50.0;
  double noise_pa = 2.0;        // Pa, standard deviation of a sample
  double bias_sigma_pa = 50.0;  // Pa, constant bias, drawn once per run
  double bias_walk_pa = 0.5;    // Pa/sqrt(s), random walk of the bias
};

struct MagnetometerSettings {
  double rate_hz = 100.0;
  double noise_gauss = 0.002;       // standard deviation of a sample, each axis
  double bias_sigma_gauss = 0.005;  // constant bias, drawn once per run for each axis
};

struct GpsSettings {
  double rate_hz = 10.0;                                // 0: none
  Eigen::Vector3d position_noise_ned{0.05, 0.05, 0.1};  // m, standard deviation of a sample
  Eigen::Vector3d position_drift_ned{0.3, 0.3, 0.6};    // m, of an error that changes slowly
  double drift_time_constant_s = 60.0;                  // correlation time of this error
  Eigen::Vector3d velocity_noise_ned{0.05, 0.05, 0.1};  // m/s, standard deviation of a sample
};

// What the vehicle brings in place of IMU samples: nothing, the estimate of its on-board estimator, or that of position
// sensors of its own (odometry.hpp).
enum class OdometrySource : std::uint8_t { kNone, kMocap, kOwnSensors };

struct OdometrySettings {
  OdometrySource source = OdometrySource::kNone;  // not a key of the file (`--odometry`)
  // The errors of its own sensors: standard deviations of what changes smoothly.
  double position_drift_m = 0.1;  // each axis
  double heading_drift_rad = 0.02;
  double drift_time_constant_s = 20.0;  // of these errors
};

struct SimulationSettings {
  std::string name = "default";
  std::int64_t step_ns = 1'000'000;  // integration step
  double command_timeout_s = 0.5;    // the vehicle stops its rotors after this time without a valid command
  double command_hold_s = 0.2;       // it obeys a command for this time, then levels itself and sinks
  // At which the vehicle accepts commands; not a key of the file (`--level`).
  ControlLevels control_levels = ControlLevel::kActuators;
  double rotor_speed_rate_hz = 500.0;  // of rotor speed samples; 0: the vehicle does not measure them
  ImuSettings imu;
  MocapSettings mocap;
  RadioSettings radio;
  SupplySettings supply;
  AirSettings air;
  GroundSettings ground;
  SiteSettings site;
  BarometerSettings barometer;
  MagnetometerSettings magnetometer;
  GpsSettings gps;
  OdometrySettings odometry;
  std::vector<Fault> faults;  // injected faults, in any order
};

// Period of a rate, rounded to 1 ns; 0 for a rate of 0.
std::int64_t period_ns(double rate_hz);

// Returns every rule that the settings violate. Keys are those of the simulation file ("imu.rate_hz").
std::vector<Violation> validate(const SimulationSettings& settings);

}  // namespace swiftlet::plant
