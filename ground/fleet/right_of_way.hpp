// Who goes first where two paths come near each other, as the plan has it: the order in which vehicles must pass, so that
// one that is late is waited for. Following M. Cap, J. Gregoire, E. Frazzoli, "Provably safe and deadlock-free execution
// of multi-robot plans under delaying disturbances", IROS 2016 (RMTRACK).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/ground/fleet/flight_path.hpp"
#include "swiftlet/ground/fleet/separation.hpp"

namespace swiftlet::ground {

// The path of each vehicle is cut into cells of equal path time. Cell k of one vehicle and cell m of another conflict if
// their ellipsoids might touch while the one is anywhere in k and the other anywhere in m, by a bound of their speeds. For
// m < k the other one has the right of way: it must have left m before the first one enters k.
class RightOfWay {
 public:
  static constexpr double kCell_s = 0.05;

  struct Vehicle {
    FlightPath path;
    Ellipsoid around;      // that no other's may touch when vehicles are late
    double lands_s = 0.0;  // path time from which it cannot stop, because it lands
  };

  // vehicles: flown from one common start.
  explicit RightOfWay(const std::vector<Vehicle>& vehicles);

  std::size_t vehicles() const { return cells_.size(); }

  // The path time, s, up to which vehicle i may fly while the others are at these path times. progress_s: at most one cell
  // behind where each is. Infinite: to its end. blocker: set to the vehicle that it has to wait for, if there is one.
  double limit_s(std::size_t i, const std::vector<double>& progress_s, std::size_t& blocker) const;

  // The time that passes in the plan between one vehicle leaving a conflict and the next one entering it. While it is at
  // least the time in which the second can stop, nobody waits in a flight on time, and no vehicles wait for each other.
  struct Slack {
    double slack_s = 0.0;  // infinite without a conflict
    std::size_t first = 0, second = 0;
    double at_s = 0.0;  // when the second one enters
  };
  // The one with the least to spare. needed_s: time in which each vehicle can stop.
  Slack least_slack(const std::vector<double>& needed_s) const;

 private:
  struct Cells {
    std::vector<Eigen::Vector3d> centres;  // m NED
    std::vector<double> reach_m;           // from the centre, within the cell
  };
  static Cells cells_of(const FlightPath& path);

  std::vector<Cells> cells_;
  // awaited_[i][j][k]: the last cell m < k of j that conflicts with cell k of i; -1: none.
  std::vector<std::vector<std::vector<std::int32_t>>> awaited_;
};

}  // namespace swiftlet::ground
