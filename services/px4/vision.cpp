#include "swiftlet/services/px4/vision.hpp"

#include <cmath>

namespace swiftlet::px4 {
namespace {

constexpr double kFastest = 15.0;  // m/s
constexpr double kLeastJump_m = 0.3;
constexpr double kFastestTurn = 20.0;  // rad/s
constexpr double kLeastTurn_rad = 0.5;
constexpr std::int64_t kOldNs = 500'000'000;
constexpr double kRateMargin = 0.9;  // of the period: frames that come early

}  // namespace

bool Vision::jumps(const plant::PoseSample& pose) const {
  const double dt_s = static_cast<double>(pose.stamp_ns - last_->stamp_ns) * 1e-9;
  const double moved_m = (pose.position_ned - last_->position_ned).norm();
  const double turned_rad = pose.q_ned_from_frd.angularDistance(last_->q_ned_from_frd);
  return moved_m > kLeastJump_m + kFastest * dt_s || turned_rad > kLeastTurn_rad + kFastestTurn * dt_s;
}

std::optional<msg::VehicleOdometry> Vision::take(const plant::PoseSample& pose, std::int64_t now_ns,
                                                 std::int64_t system_minus_now_ns) {
  if (!pose.tracked || now_ns - pose.stamp_ns > kOldNs) return std::nullopt;
  if (last_ && pose.stamp_ns <= last_->stamp_ns) return std::nullopt;
  if (last_ && jumps(pose)) ++resets_;
  last_ = pose;
  if (settings_.rate_hz <= 0.0) return std::nullopt;
  const auto period_ns = static_cast<std::int64_t>(kRateMargin * 1e9 / settings_.rate_hz);
  if (passed_ > 0 && pose.stamp_ns - passed_ns_ < period_ns) return std::nullopt;
  passed_ns_ = pose.stamp_ns;
  ++passed_;
  const std::int64_t system_ns = pose.stamp_ns + system_minus_now_ns;
  const std::uint64_t stamp_us =
      settings_.stamps == VisionStamps::kAgent ? static_cast<std::uint64_t>(system_ns / 1000) : 0;
  return to_px4(pose, settings_.deviation, resets_, stamp_us);
}

}  // namespace swiftlet::px4
