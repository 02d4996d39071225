#include "tests/support/scripted_autopilot.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <Eigen/Geometry>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/math/geodesy.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/support/eventually.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Clock = std::chrono::steady_clock;

constexpr double kSupply_v = 3.9;  // assumed
// Gains of the loops, each slower than the one below it.
constexpr double kRate_1_s = 20.0;
constexpr double kAttitude_1_s = 6.0;
constexpr double kVelocity_1_s = 3.0;
constexpr double kPosition_1_s2 = 2.5;
constexpr double kIntegral_1_s3 = 1.0;

// The control of a rotor of a quadrotor in X in PX4's numbers, from 0.
std::size_t px4_control(const Vector3d& position_frd) {
  const bool front = position_frd.x() > 0.0;
  const bool right = position_frd.y() > 0.0;
  if (front && right) return 0;
  if (!front && !right) return 1;
  return front ? 2 : 3;
}

Vector3d limited(const Vector3d& v, double limit) { return v.cwiseMax(-limit).cwiseMin(limit); }

}  // namespace

ScriptedAutopilot::ScriptedAutopilot(const plant::Vehicle& vehicle, const plant::SiteSettings& site,
                                     const ScriptedAutopilotSettings& settings)
    : vehicle_(vehicle),
      site_(site),
      settings_(settings),
      allocation_(plant::pseudo_inverse(plant::effectiveness(vehicle))) {}

ScriptedAutopilot::~ScriptedAutopilot() { disconnect(); }

bool ScriptedAutopilot::connect(int port, std::chrono::milliseconds timeout) {
  const sockaddr_in address = io::socket_address("127.0.0.1", port);
  const bool connected = eventually(
      [&] {
        disconnect();
        descriptor_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const int on = 1;
        ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        return ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
      },
      timeout);
  if (connected) introduce();
  return connected;
}

void ScriptedAutopilot::use(int descriptor) {
  disconnect();
  descriptor_ = descriptor;
  introduce();
}

void ScriptedAutopilot::disconnect() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void ScriptedAutopilot::introduce() {
  parser_.reset();
  mavlink::CommandLong request;
  request.command = mavlink::CommandLong::kSetMessageInterval;
  request.params = {static_cast<float>(mavlink::HilStateQuaternion::kId),
                    static_cast<float>(settings_.period_us)};
  send_message(request, settings_.system_id);
  mavlink::Heartbeat heartbeat;
  heartbeat.autopilot = 12;  // PX4
  send_message(heartbeat, settings_.system_id);
}

void ScriptedAutopilot::send(const std::vector<std::uint8_t>& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    ssize_t now = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno == ENOTSOCK) now = ::write(descriptor_, bytes.data() + sent, bytes.size() - sent);
    if (now <= 0) return;
    sent += static_cast<std::size_t>(now);
  }
}

bool ScriptedAutopilot::fly_until(double time_s, std::chrono::milliseconds timeout) {
  const auto end_us = static_cast<std::uint64_t>(time_s * 1e6);
  std::array<std::uint8_t, 4096> received{};
  while (time_us_ < end_us) {
    pollfd readable{descriptor_, POLLIN, 0};
    if (::poll(&readable, 1, static_cast<int>(timeout.count())) <= 0) return false;
    const ssize_t size = ::read(descriptor_, received.data(), received.size());
    if (size <= 0) return false;
    log_.bytes.insert(log_.bytes.end(), received.begin(), received.begin() + size);
    parser_.feed(received.data(), static_cast<std::size_t>(size),
                 [this](const auto& frame) { on_frame(frame); });
  }
  return true;
}

void ScriptedAutopilot::on_frame(const mavlink::Frame& frame) {
  switch (frame.message_id) {
    case mavlink::HilSensor::kId:
      on_sensor(mavlink::from_frame<mavlink::HilSensor>(frame));
      break;
    case mavlink::HilStateQuaternion::kId:
      on_state(mavlink::from_frame<mavlink::HilStateQuaternion>(frame));
      break;
    case mavlink::HilGps::kId:
      if (log_.gps++ == 0) log_.first_gps = mavlink::from_frame<mavlink::HilGps>(frame);
      break;
    case mavlink::Heartbeat::kId:
      ++log_.heartbeats;
      break;
    case mavlink::SystemTime::kId:
      ++log_.times;
      break;
    default:
      break;
  }
}

void ScriptedAutopilot::on_sensor(const mavlink::HilSensor& sensor) {
  using mavlink::HilSensor;
  const auto received = Clock::now();
  const auto has = [&](std::uint32_t fields) { return (sensor.fields_updated & fields) == fields; };
  if (!log_.sensor_times_us.empty() && sensor.time_usec != time_us_ + settings_.period_us) ++log_.irregular;
  log_.sensor_times_us.push_back(sensor.time_usec);
  time_us_ = sensor.time_usec;
  if (has(HilSensor::kMagnetometer)) ++log_.magnetometers;
  if (has(HilSensor::kBarometer) && log_.barometers++ == 0) log_.first_barometer = sensor;
  if (!has(HilSensor::kAccelerometer | HilSensor::kGyro)) return;
  if (log_.imus++ % settings_.samples_per_answer != 0) return;
  send_message(controls(sensor), settings_.system_id);
  log_.answer_times_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - received).count());
}

void ScriptedAutopilot::on_state(const mavlink::HilStateQuaternion& state) {
  ++log_.states;
  state_ = state;
  const math::GeographicPosition position{1e-7 * state.lat, 1e-7 * state.lon};
  log_.position_ned.head<2>() = math::north_east_of({site_.latitude_deg, site_.longitude_deg}, position);
  log_.height_m = 1e-3 * state.alt - site_.altitude_m;
  log_.position_ned.z() = -log_.height_m;
}

mavlink::HilActuatorControls ScriptedAutopilot::controls(const mavlink::HilSensor& sensor) {
  mavlink::HilActuatorControls controls;
  controls.time_usec = sensor.time_usec;
  controls.flags = settings_.lockstep ? mavlink::HilActuatorControls::kLockstep : 0;
  controls.mode = 1;
  if (static_cast<double>(sensor.time_usec) * 1e-6 < settings_.arms_at_s || log_.states == 0) return controls;
  controls.mode |= mavlink::HilActuatorControls::kArmed;
  const plant::RotorThrusts rotor_thrusts =
      thrusts({double{sensor.gyro[0]}, double{sensor.gyro[1]}, double{sensor.gyro[2]}});
  for (std::size_t i = 0; i < vehicle_.rotors.size(); ++i) {
    const double thrust = std::max(rotor_thrusts[static_cast<Eigen::Index>(i)], 0.0);
    controls.controls[px4_control(vehicle_.rotors[i].position_frd)] =
        static_cast<float>(plant::throttle_from_steady_thrust(vehicle_, kSupply_v, thrust));
  }
  return controls;
}

plant::RotorThrusts ScriptedAutopilot::thrusts(const Vector3d& body_rates) {
  const double dt = static_cast<double>(settings_.period_us) * 1e-6;
  const auto& q = state_.attitude_quaternion;
  const Quaterniond attitude(double{q[0]}, double{q[1]}, double{q[2]}, double{q[3]});
  const Vector3d velocity(0.01 * state_.velocity[0], 0.01 * state_.velocity[1], 0.01 * state_.velocity[2]);
  const Vector3d error = limited(Vector3d(0.0, 0.0, -settings_.height_m) - log_.position_ned, 0.5);
  integral_ = limited(integral_ + dt * error, 3.0);

  const Vector3d acceleration =
      kPosition_1_s2 * error + kIntegral_1_s3 * integral_ - kVelocity_1_s * velocity;
  const Vector3d specific_thrust = acceleration - Vector3d(0.0, 0.0, plant::kGravity);  // up
  // Turns the thrust axis, -z of FRD, onto it, and the nose to the north.
  const Vector3d down = -specific_thrust.normalized();
  const Quaterniond level = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), down);
  Quaterniond turn = attitude.conjugate() * level;
  if (turn.w() < 0.0) turn.coeffs() *= -1.0;
  const Vector3d rates = limited(2.0 * kAttitude_1_s * turn.vec(), 3.0);
  const Vector3d moment = vehicle_.inertia * (kRate_1_s * (rates - body_rates));
  Eigen::Vector4d wrench;
  wrench << vehicle_.mass_kg * specific_thrust.norm(), moment;
  return allocation_ * wrench;
}

int free_tcp_port() {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = io::socket_address("127.0.0.1", 0);
  socklen_t size = sizeof address;
  const bool bound = ::bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
                     ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(descriptor);
  return bound ? ntohs(address.sin_port) : -1;
}

}  // namespace swiftlet::tests
