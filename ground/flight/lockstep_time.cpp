#include "swiftlet/ground/flight/lockstep_time.hpp"

#include <algorithm>

#include "swiftlet/plant/model/telemetry_rate.hpp"
#include "swiftlet/simulation/mission_runner.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using simulation::FlightSchedule;

constexpr auto kNewsTimeout = 300ms;                     // until a status of the last sample has come
constexpr std::int64_t kTelemetryPeriodNs = 10'000'000;  // of the samples that a status may tell of

}  // namespace

LockstepTime::LockstepTime(Client& client, std::int64_t started_ns)
    : client_(client), started_ns_(started_ns) {
  set_limit(started_ns + FlightSchedule::kLandAfterNs);
}

// Without samples, as while a fault stops the IMU, there is no status for which time could wait.
void LockstepTime::follow(const View& view) {
  const bool left = has_left_mission(view);
  const std::int64_t news_ns = left ? view.left_mission_ns : view.control.message.stamp_ns();
  if (news_ns + FlightSchedule::kLandAfterNs > limit_ns_) set_limit(news_ns + FlightSchedule::kLandAfterNs);
  if (!left && is_at_limit(view) && Clock::now() - limit_set_ > kNewsTimeout) go_on();
}

bool LockstepTime::is_at_limit(const View& view) const {
  const msg::VehicleInfo& vehicle = view.vehicle.message;
  return vehicle.paused() && vehicle.stamp_ns() + plant::period_ns(vehicle.imu_rate_hz()) > limit_ns_;
}

bool LockstepTime::stands(const View& view) const {
  const bool told = view.control.message.stamp_ns() + kTelemetryPeriodNs > view.vehicle.message.stamp_ns();
  return is_at_limit(view) && (told || Clock::now() - limit_set_ > kNewsTimeout);
}

void LockstepTime::go_on() { set_limit(limit_ns_ + FlightSchedule::kLandAfterNs); }

void LockstepTime::set_limit(std::int64_t limit_ns) {
  limit_ns_ = limit_ns;
  limit_set_ = Clock::now();
  client_.simulation_clock().up_to(limit_ns);
}

}  // namespace swiftlet::ground
