// The time of a flight in lockstep, from the start of its mission on.
#pragma once

#include <cstdint>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

// Time runs ahead of control's last status in the mission by FlightSchedule::kLandAfterNs at most. So it stands at the same
// stamp after each abort of the same flight, and a request that is made there leads to the same flight as in one process.
class LockstepTime {
 public:
  // The client must outlive this object. Time stands at started_ns.
  LockstepTime(Client& client, std::int64_t started_ns);

  // Call with each status of control.
  void follow(const View& view);
  bool has_left_mission(const View& view) const { return view.left_mission_ns > started_ns_; }
  // Whether time stands, and the view shows the vehicle's mode there.
  bool stands(const View& view) const;
  void go_on();  // by another FlightSchedule::kLandAfterNs

 private:
  bool is_at_limit(const View& view) const;
  void set_limit(std::int64_t limit_ns);

  Client& client_;
  std::int64_t started_ns_;
  std::int64_t limit_ns_ = 0;
  Clock::time_point limit_set_;  // when
};

}  // namespace swiftlet::ground
