#include "swiftlet/ground/vehicle_check/motion_watch.hpp"

#include <algorithm>

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kStill_ns = 700'000'000;
constexpr double kStill_m = 0.02;  // a hand trembles
constexpr double kStill_rad = 0.07;
constexpr double kTurned_rad = 0.4;
constexpr double kMoved_m = 0.2;
constexpr std::int64_t kWave_ns = 3'000'000'000;

double turn_rad(const plant::PoseSample& a, const plant::PoseSample& b) {
  return a.q_ned_from_frd.angularDistance(b.q_ned_from_frd);
}
double move_m(const plant::PoseSample& a, const plant::PoseSample& b) {
  return (a.position_ned - b.position_ned).norm();
}

}  // namespace

bool MotionWatch::is_still() const {
  const Entry& now = window_.back();
  if (now.received_ns - window_.front().received_ns < kStill_ns) return false;
  return std::all_of(window_.begin(), window_.end(), [&](const Entry& entry) {
    return turn_rad(entry.pose, now.pose) < kStill_rad && move_m(entry.pose, now.pose) < kStill_m;
  });
}

bool MotionWatch::has_moved(const Entry& now) {
  switch (*step_) {
    case HandStep::kForward:
    case HandStep::kUp:
      return move_m(begin_->pose, now.pose) > kMoved_m;
    case HandStep::kWave:
      if (turn_rad(begin_->pose, now.pose) > kStill_rad && !moving_since_ns_)
        moving_since_ns_ = now.received_ns;
      return moving_since_ns_ && now.received_ns - *moving_since_ns_ > kWave_ns;
    default:
      return turn_rad(begin_->pose, now.pose) > kTurned_rad;
  }
}

void MotionWatch::expect(HandStep step) {
  step_ = step;
  moved_ = false;
  moving_since_ns_.reset();
  if (!window_.empty() && is_still()) begin_ = window_.front();
}

std::optional<HandSegment> MotionWatch::update(const plant::PoseSample& pose, std::int64_t received_ns) {
  window_.push_back({pose, received_ns});
  // Keeps one entry that is older than the window, so that it spans it.
  while (window_.size() > 2 && received_ns - window_[1].received_ns >= kStill_ns) window_.pop_front();
  const bool still = is_still();
  if (step_ && !moved_ && begin_) moved_ = has_moved(window_.back());
  if (!moved_ && !moving_since_ns_ && still) begin_ = window_.front();
  if (!moved_ || !still) return std::nullopt;
  return HandSegment{*step_, begin_->received_ns, received_ns};
}

}  // namespace swiftlet::ground
