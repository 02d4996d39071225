// Whoever asks the vehicle for this and that: arms it, takes off, sends it from place to place, on missions,
// along trajectories and by setpoints, lands it, and begins anew when it stands on its feet again. Drawn from
// the seed. Stays a metre inside the fence at up to 1.5 m/s: who loses all control there falls inside it.
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

  // What it asks for between two samples, if anything.
  void act(ground::ClosedLoop& loop);

  int take_offs() const { return take_offs_; }

 private:
  Eigen::Vector3d place();
  double speed() { return random_.uniform(0.3, 1.5); }
  bool ask(ground::ClosedLoop& loop, const control::Request& request, const std::string& what);
  void arm(ground::ClosedLoop& loop);
  void take_off(ground::ClosedLoop& loop);
  void go_on(ground::ClosedLoop& loop);
  void go_to(ground::ClosedLoop& loop);
  void fly_mission(ground::ClosedLoop& loop, bool from_ground);
  void fly_trajectory(ground::ClosedLoop& loop);
  void begin_setpoints(ground::ClosedLoop& loop);
  void send_setpoint(ground::ClosedLoop& loop);
  void land(ground::ClosedLoop& loop);
  void wait(double seconds) { next_ns_ = now_ns_ + static_cast<std::int64_t>(seconds * 1e9); }

  control::Limits limits_;
  Log log_;
  plant::RandomStream random_;
  std::int64_t now_ns_ = 0;
  std::int64_t next_ns_;
  int take_offs_ = 0;
  std::deque<control::Mission> missions_;  // the controller may fly any of them still
  std::deque<control::Trajectory> trajectories_;
  // The stream of setpoints.
  std::int64_t setpoints_until_ns_ = 0;
  std::int64_t next_setpoint_ns_ = 0;
  control::Setpoint setpoint_;
};

}  // namespace swiftlet::soak
