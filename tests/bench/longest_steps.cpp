#include "tests/bench/longest_steps.hpp"

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <functional>
#include <random>
#include <stdexcept>

#include "swiftlet/control/planning/spline.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::tests {
namespace {

using control::RequestKind;
using Eigen::Vector3d;

constexpr int kRepetitions = 3;
constexpr int kEvents = 200;         // of each kind
constexpr int kStepsPerEvent = 100;  // 0.2 s between events; all but the first meet a vehicle in motion

double cpu_us() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_nsec);
}

class Flight {
 public:
  Flight()
      : loop_(io::load_vehicle(io::find_config("vehicles/kaylion.yaml")),
              io::load_simulation_settings(io::find_config("simulation/default.yaml")),
              io::load_control_settings(io::find_config("control/motor_lag.yaml")), 1) {
    loop_.step_until([this] { return loop_.time_s() > 1.0; }, 2.0);
    require(request(RequestKind::kArm));
    require(request(RequestKind::kTakeoff, {0.0, 0.0, -1.0}));
    if (!loop_.step_until([this] { return loop_.controller.status().mode == control::Mode::kHolding; }, 10.0))
      throw std::runtime_error("the vehicle did not take off");
  }

  // The CPU times of the steps at which `event` is called, and of all others.
  struct Times {
    std::vector<double> events_us, plain_us;
    int refused = 0;  // events
  };
  Times fly(const std::function<control::Outcome(Flight&)>& event) {
    Times times;
    for (int i = 0; i < kEvents; ++i) {
      const double before_us = cpu_us();
      const control::Outcome outcome = event(*this);
      loop_.step();
      times.events_us.push_back(cpu_us() - before_us);
      if (!outcome.accepted) ++times.refused;
      for (int step = 1; step < kStepsPerEvent; ++step) {
        const double start_us = cpu_us();
        loop_.step();
        times.plain_us.push_back(cpu_us() - start_us);
      }
    }
    return times;
  }

  control::Outcome request(RequestKind kind, const Vector3d& position_ned = Vector3d::Zero(),
                           const control::Trajectory* trajectory = nullptr) {
    control::Request request;
    request.kind = kind;
    request.position_ned = position_ned;
    request.speed = 1.0;
    request.trajectory = trajectory;
    return loop_.controller.request(request);
  }
  control::Outcome velocity(const Vector3d& velocity_ned) {
    control::Setpoint setpoint;
    setpoint.kind = control::SetpointKind::kVelocity;
    setpoint.stamp_ns = loop_.plant.stamp_ns();
    setpoint.velocity_ned = velocity_ned;
    setpoint.yaw_free = true;
    return loop_.controller.on_setpoint(setpoint);
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector3d position() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.6, -0.6)}; }

 private:
  static void require(const control::Outcome& outcome) {
    if (!outcome.accepted) throw std::runtime_error(outcome.reason);
  }

  simulation::ClosedLoop loop_;
  std::mt19937 random_{1};
};

control::Trajectory through_two_positions(Flight& flight) {
  std::vector<control::PositionYaw> points(3);
  for (control::PositionYaw& point : points) {
    const Vector3d position = flight.position();
    point << position.x(), position.y(), position.z(), 0.0;
  }
  return {1, control::spline(control::Smoothness::kMinimumSnap, points, {2.5, 2.5})};
}

StepTimes summary(const std::string& what, std::vector<double> times_us) {
  std::sort(times_us.begin(), times_us.end());
  return {what, times_us[times_us.size() / 2], times_us.back()};
}

void keep_shortest(std::vector<double>& times, const std::vector<double>& again) {
  if (times.empty()) times = again;
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = std::min(times[i], again[i]);
}

}  // namespace

std::vector<StepTimes> longest_steps() {
  // Trajectories are made by the ground and live as long as they are flown.
  std::vector<control::Trajectory> trajectories;
  trajectories.reserve(kEvents);
  struct Kind {
    std::string what;
    std::function<control::Outcome(Flight&)> event;
  };
  std::size_t next = 0;
  const std::vector<Kind> kinds = {
      {"trajectory joined in motion",
       [&](Flight& flight) {
         return flight.request(RequestKind::kTrajectory, Vector3d::Zero(), &trajectories[next++ % kEvents]);
       }},
      {"goto in motion",
       [](Flight& flight) { return flight.request(RequestKind::kGoTo, flight.position()); }},
      {"hold or goto in motion",
       [hold = false](Flight& flight) mutable {
         hold = !hold;
         return flight.request(hold ? RequestKind::kHold : RequestKind::kGoTo, flight.position());
       }},
      {"velocity setpoint",
       [](Flight& flight) {
         return flight.velocity({flight.uniform(-0.8, 0.8), flight.uniform(-0.8, 0.8), 0.0});
       }},
  };
  {
    Flight planner;
    for (int i = 0; i < kEvents; ++i) trajectories.push_back(through_two_positions(planner));
  }
  std::vector<StepTimes> out;
  std::vector<double> plain_us;
  for (const Kind& kind : kinds) {
    std::vector<double> events_us, others_us;
    for (int repetition = 0; repetition < kRepetitions; ++repetition) {
      Flight flight;
      next = 0;
      const Flight::Times times = flight.fly(kind.event);
      if (10 * times.refused > kEvents)
        throw std::runtime_error(kind.what + ": too many events were refused");
      keep_shortest(events_us, times.events_us);
      keep_shortest(others_us, times.plain_us);
    }
    plain_us.insert(plain_us.end(), others_us.begin(), others_us.end());
    out.push_back(summary(kind.what, events_us));
  }
  out.insert(out.begin(), summary("no request", plain_us));
  return out;
}

}  // namespace swiftlet::tests
