#include "swiftlet/ground/fleet/order_execution.hpp"

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::ground {
namespace {

namespace msg = messages::msg;

constexpr double kOtherPlace_m = 0.2;  // from that to which the vehicle was sent: it is sent again

// Whether an accepted request of this kind ends or changes the motion of a vehicle.
bool moves(const msg::RequestStatus& request) {
  return request.state() != msg::RequestStatus_Constants::UNKNOWN &&
         request.kind() != msg::RequestStatus_Constants::KIND_SETTINGS &&
         request.kind() != msg::RequestStatus_Constants::KIND_MISSION_UPLOAD;
}

}  // namespace

MissionNews mission_news(const msg::ControlStatus& control, const msg::MissionStatus& mission,
                         std::uint64_t mission_id) {
  MissionNews news;
  if (mission.mission_id() == mission_id && mission.state() == msg::MissionStatus_Constants::RUNNING)
    news.state = MissionNews::State::kRuns;
  // While control_status is older than the pause, it does not say yet whose that is.
  const bool knows = control.mode() != static_cast<std::uint8_t>(control::Mode::kMission);
  if (mission.mission_id() == mission_id && mission.state() == msg::MissionStatus_Constants::PAUSED && knows)
    news.state = MissionNews::State::kPaused;
  if (moves(control.request())) {
    news.moved_by = control.request().client();
    return news;
  }
  for (const msg::RequestStatus& request : control.earlier_requests()) {
    if (!moves(request)) continue;
    news.moved_by = request.client();
    break;
  }
  return news;
}

OrderExecution::Request OrderExecution::next(const Order& order, const MissionNews& news,
                                             std::optional<std::uint64_t> own_client) {
  if (news.state == MissionNews::State::kRuns) {
    of_others_ = false;
    sent_to_ned_.reset();
  }
  if (news.state == MissionNews::State::kPaused && (!own_client || news.moved_by != own_client))
    of_others_ = true;
  switch (order.kind) {
    case Order::Kind::kFly:
      return news.state == MissionNews::State::kPaused && !of_others_ ? Request::kResume : Request::kNone;
    case Order::Kind::kPause:
      return news.state == MissionNews::State::kRuns ? Request::kPause : Request::kNone;
    case Order::Kind::kStepAside:
      if (news.state == MissionNews::State::kRuns) return Request::kPause;
      if (news.state != MissionNews::State::kPaused) return Request::kNone;
      return sent_to_ned_ && (*sent_to_ned_ - order.place_ned).norm() < kOtherPlace_m ? Request::kNone
                                                                                      : Request::kGoTo;
  }
  return Request::kNone;
}

void OrderExecution::accepted(Request request, const Order& order) {
  if (request == Request::kGoTo) sent_to_ned_ = order.place_ned;
}

}  // namespace swiftlet::ground
