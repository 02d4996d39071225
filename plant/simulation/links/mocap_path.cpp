#include "swiftlet/plant/simulation/links/mocap_path.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {

namespace {

constexpr FaultKind kMocapFaults[] = {FaultKind::kMocapStop,      FaultKind::kMocapFreeze,
                                      FaultKind::kMocapUntracked, FaultKind::kMocapJump,
                                      FaultKind::kMocapSwap,      FaultKind::kMocapLatency};

std::size_t delay_capacity(const FaultSchedule& faults, const MocapSettings& mocap) {
  const double longest_s = faults.longest_delay_s(FaultKind::kMocapLatency);
  return longest_s > 0.0 ? static_cast<std::size_t>(longest_s * mocap.rate_hz) + 2 : 0;
}

}  // namespace

MocapPath::MocapPath(const SimulationSettings& settings, std::uint64_t seed)
    : faults_(settings.faults),
      faultless_(std::none_of(std::begin(kMocapFaults), std::end(kMocapFaults),
                              [this](FaultKind kind) { return faults_.has(kind); })),
      other_body_error_m_(settings.mocap.position_error_m),
      other_body_noise_(seed, streams::kMocapOtherBody),
      delayed_(delay_capacity(faults_, settings.mocap)) {}

std::optional<PoseSample> MocapPath::pass(const std::optional<PoseSample>& frame, std::int64_t now_ns) {
  if (faultless_) return frame;
  if (now_ns < last_ns_) {
    delayed_.clear();
    last_tracked_.reset();
  }
  last_ns_ = now_ns;
  std::optional<PoseSample> out = delayed_.take(now_ns);
  if (!frame || faults_.active(FaultKind::kMocapStop, now_ns) != nullptr) return out;
  PoseSample seen = *frame;
  disturb(seen, now_ns);
  if (const Fault* late = faults_.active(FaultKind::kMocapLatency, now_ns)) {
    delayed_.put(seen, now_ns + math::nanoseconds(late->delay_s));
    return out;
  }
  delayed_.clear();  // older frames are superseded
  return seen;
}

void MocapPath::disturb(PoseSample& frame, std::int64_t now_ns) {
  if (const Fault* swap = faults_.active(FaultKind::kMocapSwap, now_ns)) {
    frame.tracked = true;
    frame.position_ned = swap->position_ned + other_body_error_m_ * other_body_noise_.in_unit_ball();
    frame.q_ned_from_frd = math::rotation({0.0, 0.0, swap->yaw_rad});
  }
  if (const Fault* jump = faults_.active(FaultKind::kMocapJump, now_ns); jump != nullptr && frame.tracked) {
    frame.position_ned += jump->position_ned;
    frame.q_ned_from_frd = frame.q_ned_from_frd * math::rotation(jump->rotation_frd);
  }
  if (faults_.active(FaultKind::kMocapFreeze, now_ns) == nullptr) {
    if (frame.tracked) last_tracked_ = frame;
  } else if (last_tracked_) {
    frame.tracked = true;
    frame.position_ned = last_tracked_->position_ned;
    frame.q_ned_from_frd = last_tracked_->q_ned_from_frd;
  }
  if (faults_.active(FaultKind::kMocapUntracked, now_ns) != nullptr) {
    PoseSample untracked;
    untracked.stamp_ns = frame.stamp_ns;
    untracked.sequence = frame.sequence;
    frame = untracked;
  }
}

}  // namespace swiftlet::plant
