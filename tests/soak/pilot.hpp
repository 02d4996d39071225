// A random pilot, sampled from the seed: arms, takes off, flies to positions, missions, trajectories and
// setpoints, lands, and starts again when the vehicle stands upright. Stays 1 m inside the fence at up to 1.5
// m/s, so that a vehicle that loses all control falls inside the fence.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::soak {

using Log = std::function<void(const std::string&)>;

class Pilot {
 public:
  Pilot(std::uint64_t seed, const control::Limits& limits, Log log);

  // Sends requests between two samples, if any are due.
  void act(simulation::ClosedLoop& loop);

  int take_offs() const { return take_offs_; }

 private:
  Eigen::Vector3d sample_position();
  double speed() { return random_.uniform(0.3, 1.5); }
  bool ask(simulation::ClosedLoop& loop, const control::Request& request, const std::string& what);
  void arm(simulation::ClosedLoop& loop);
  void take_off(simulation::ClosedLoop& loop);
  void start_random_action(simulation::ClosedLoop& loop);
  void go_to(simulation::ClosedLoop& loop);
  void fly_mission(simulation::ClosedLoop& loop, bool from_ground);
  void fly_trajectory(simulation::ClosedLoop& loop);
  void begin_setpoints(simulation::ClosedLoop& loop);
  void send_setpoint(simulation::ClosedLoop& loop);
  void land(simulation::ClosedLoop& loop);
  void wait(double seconds) { next_ns_ = now_ns_ + static_cast<std::int64_t>(seconds * 1e9); }

  control::Limits limits_;
  Log log_;
  math::RandomStream random_;
  std::int64_t now_ns_ = 0;
  std::int64_t next_ns_;
  int take_offs_ = 0;
  std::deque<control::Mission> missions_;  // the controller may still fly any of them
  std::deque<control::Trajectory> trajectories_;
  // The stream of setpoints.
  std::int64_t setpoints_until_ns_ = 0;
  std::int64_t next_setpoint_ns_ = 0;
  control::Setpoint setpoint_;
};

}  // namespace swiftlet::soak
