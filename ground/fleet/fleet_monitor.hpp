// Keeps the vehicles of a fleet apart in flight, when one of them stops, is late, leaves its path or is no longer heard.
//
//   on its path, late       those that come after it (right_of_way.hpp) stop on their paths, and go on when it has passed
//   off its path, or lost   it may land or fall: nobody enters the column below it; who is in it steps aside, and goes back to
//                           its path when nobody is above the way, nor comes there meanwhile
//   sent aside              nobody enters the column below it and below its way back; who is there already waits
//
// Of two vehicles off their paths the one of lower priority steps aside. Nobody waits for good: places on paths that vehicles
// have reached are apart (right_of_way.hpp), so that each can go back to its own past others that stand, if not straight then by
// a place beside them; one that was sent aside and stands in another's way back is sent on. Pure logic: it is told what is
// known, and says what each vehicle should do. In a step only one vehicle searches for such a place.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/ground/fleet/flight_path.hpp"
#include "swiftlet/ground/fleet/right_of_way.hpp"
#include "swiftlet/ground/fleet/separation.hpp"

namespace swiftlet::ground {

// One vehicle, as the monitor knows it at the start.
struct MonitoredVehicle : RightOfWay::Vehicle {
  double stop_s = 0.5;  // path time in which it stops after it is told to, with the delay until it hears that
  int priority = 1;
  Eigen::AlignedBox2d room{Eigen::Vector2d::Constant(-1e9),
                           Eigen::Vector2d::Constant(1e9)};  // m NED: where it may go
};

// What is known of a vehicle at one time.
struct VehicleNews {
  Eigen::Vector3d reference_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();   // m, estimated
  double age_s = 0.0;                                       // of these
  bool flies_plan = true;   // its mission runs or is paused by this monitor; false: it does something else
  bool rotors_off = false;  // it stands, or falls
};

struct Order {
  // kFly: on along its path, from elsewhere straight back to it. kPause: stay, on the path or where it is. kStepAside: go
  // to place_ned.
  enum class Kind { kFly, kPause, kStepAside };
  Kind kind = Kind::kFly;
  Eigen::Vector3d place_ned = Eigen::Vector3d::Zero();  // kStepAside: where to
  std::size_t because_of = 0;                           // unless kFly: index of the other vehicle
};

class FleetMonitor {
 public:
  explicit FleetMonitor(std::vector<MonitoredVehicle> vehicles);

  // now_s: since the common start, not decreasing. news: of all vehicles. Returns an order for each.
  std::vector<Order> step(double now_s, const std::vector<VehicleNews>& news);

  // s, the path time that each vehicle has reached, as far as known.
  const std::vector<double>& progress_s() const { return progress_s_; }

  // The least slack of the plan, and what the second vehicle needs of it: FleetMonitor stops nobody in a flight on time, and
  // lets no vehicles wait for each other, while the slack is at least what is needed.
  RightOfWay::Slack least_slack() const;
  double needed_slack_s(std::size_t vehicle) const;

 private:
  enum class Status { kOnPath, kOffPath, kLost, kDown };
  // Where the monitor has sent a vehicle: nowhere, aside, on from there out of another's way back, to a place from which it can
  // fly back, or back.
  enum class Way { kPath, kAside, kOn, kAround, kBack };
  using Places = std::vector<Eigen::Vector3d>;  // m NED
  struct Scene {                                // of one step
    const std::vector<VehicleNews>& news;
    std::vector<Status> status;
    std::vector<Places> places;  // where each vehicle is or may be
  };

  void follow(std::size_t i, double elapsed_s, const VehicleNews& news);
  double landing_limit_s(std::size_t i, const VehicleNews& news) const;
  bool rejoin(std::size_t i, double elapsed_s, const VehicleNews& news);
  Status status_of(std::size_t i, const VehicleNews& news) const;
  Places places_of(std::size_t i, const VehicleNews& news, Status status) const;
  Places left_places(std::size_t i) const;
  Places way_back(std::size_t i, const Eigen::Vector3d& from_ned) const;
  bool may_sink(std::size_t i, const Scene& scene) const;
  bool stands(std::size_t i, const Scene& scene) const;
  bool in_column(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of,
                 const Eigen::Vector3d& top_ned, double share) const;
  bool is_near(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of, const Eigen::Vector3d& at_ned,
               double share) const;
  bool yields(std::size_t i, std::size_t of, const Scene& scene) const;
  bool touches(std::size_t i, const Eigen::Vector3d& place_ned, std::size_t of, const Eigen::Vector3d& at_ned,
               double share, const Scene& scene) const;
  void wait_for_late(const Scene& scene, std::vector<Order>& orders) const;
  void keep_away(std::size_t of, const Scene& scene, std::vector<Order>& orders) const;
  Eigen::Vector3d place_aside(std::size_t i, const Eigen::Vector3d& at_ned, std::size_t of,
                              const Scene& scene) const;
  bool is_free(std::size_t i, const Eigen::Vector3d& place_ned, const Scene& scene) const;
  std::optional<std::size_t> blocker(std::size_t i, const Places& way, bool has_begun, const Scene& scene,
                                     const std::vector<Order>& orders) const;
  std::optional<Eigen::Vector3d> place_beside(std::size_t i, std::size_t of, const Scene& scene,
                                              const std::vector<Order>& orders) const;
  void pass_turn();
  void send_back(std::size_t i, const Scene& scene, std::vector<Order>& orders);
  void make_way_back(std::size_t i, const Scene& scene, std::vector<Order>& orders);

  std::vector<MonitoredVehicle> vehicles_;
  RightOfWay right_of_way_;
  std::vector<double> progress_s_;
  std::vector<double> certain_s_;               // the last at which they were just there
  std::vector<double> near_s_;                  // for how long they have been near that to which they go back
  std::vector<Eigen::Vector3d> reference_ned_;  // m, of the step before
  std::vector<double> paused_s_;  // for how long they have been told to wait, and rested; negative: not told
  std::vector<Way> way_;
  std::vector<double> left_s_;              // path time at which they were sent aside
  std::vector<double> leaving_s_;           // path time that they may have flown on after that
  std::vector<Eigen::Vector3d> aside_ned_;  // where those that are aside, or on a way around, were sent
  std::size_t turn_ =
      0;  // the one of those aside that may search for a place beside another one in this step
  double now_s_ = 0.0;
};

}  // namespace swiftlet::ground
