// What to ask of a vehicle so that it carries out the orders of the fleet's monitor (ground/fleet/fleet_monitor.hpp). A mission
// that another client has paused, or moved away from its path, is not resumed. Pure logic: it is told what is known.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::ground {

// What is known of the mission of a vehicle.
struct MissionNews {
  enum class State { kOther, kRuns, kPaused };
  State state = State::kOther;
  // Client of the newest request that control has accepted and that moves a vehicle; nullopt: none is known.
  std::optional<std::uint64_t> moved_by;
};

// mission_id: of the flight.
MissionNews mission_news(const messages::msg::ControlStatus& control,
                         const messages::msg::MissionStatus& mission, std::uint64_t mission_id);

class OrderExecution {
 public:
  enum class Request { kNone, kPause, kResume, kGoTo };

  // The request to send now. own_client: of the requests of this program, known once one was answered. Call it again when
  // that is answered, or when there is news.
  Request next(const Order& order, const MissionNews& news, std::optional<std::uint64_t> own_client);
  void accepted(Request request, const Order& order);

  // Someone else has paused or moved the vehicle since its mission last ran: it is left to them.
  bool is_of_others() const { return of_others_; }

 private:
  bool of_others_ = false;
  std::optional<Eigen::Vector3d> sent_to_ned_;
};

}  // namespace swiftlet::ground
