#include "swiftlet/services/control/failover.hpp"

#include <algorithm>

namespace swiftlet::services {
namespace {

// A term consists of the count of takeovers (16 bits), the failover priority (10 bits) and six bits of the
// controller's number. Of two controllers that take over at once, the one of higher priority has the higher
// term; equal terms are very unlikely.
constexpr unsigned kPriorityShift = 6;
constexpr unsigned kCountShift = 16;
constexpr std::uint32_t kMaxCount = 0xffff;
constexpr std::uint32_t kNumberMask = 0x3f;

// One IMU sample adds at most this to the silence: a gap in the samples is not silence of the controller.
constexpr std::int64_t kMaxStepNs = 10'000'000;

}  // namespace

const char* to_string(Role role) { return role == Role::kActive ? "active" : "standby"; }

Failover::Failover(std::uint64_t controller, int failover_priority)
    : controller_(controller), failover_priority_(failover_priority) {}

std::uint32_t Failover::next_term() const {
  const std::uint32_t count = std::min((newest_term_ >> kCountShift) + 1, kMaxCount);
  return (count << kCountShift) | (static_cast<std::uint32_t>(failover_priority_) << kPriorityShift) |
         (static_cast<std::uint32_t>(controller_) & kNumberMask);
}

void Failover::heard(const Heartbeat& beat) {
  if (beat.controller == controller_) return;
  note(beat);
  newest_term_ = std::max(newest_term_, beat.term);
  if (beat.role != Role::kActive) return;
  if (role_ == Role::kActive) {
    const bool overtaken = beat.term == own_term_ ? beat.controller > controller_
                                                  : beat.term > own_term_ && !flies(beat.heard_ns);
    if (!overtaken) return;
    step_down(beat.term);
  }
  const bool recent = beat.heard_ns - followed_heard_ns_ < kForgottenNs;
  if (beat.term < followed_term_ && recent) return;
  if (beat.term != followed_term_) followed_for_ns_ = 0;
  followed_term_ = beat.term;
  followed_heard_ns_ = beat.heard_ns;
  silence_ns_ = 0;
}

void Failover::note(const Heartbeat& beat) {
  const auto known = std::find_if(peers_.begin(), peers_.end(),
                                  [&](const Heartbeat& peer) { return peer.controller == beat.controller; });
  const auto oldest =
      std::min_element(peers_.begin(), peers_.end(),
                       [](const Heartbeat& a, const Heartbeat& b) { return a.heard_ns < b.heard_ns; });
  *(known != peers_.end() ? known : oldest) = beat;
}

void Failover::step_down(std::uint32_t to_term) {
  role_ = Role::kStandby;
  newest_term_ = std::max(newest_term_, to_term);
  silence_ns_ = 0;
}

Role Failover::sample(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns) {
  pass_time(stamp_ns, obeyed, now_ns);
  loop_delay_.sample(stamp_ns, obeyed);
  obeyed_term_ = obeyed.any ? obeyed.term : 0;
  newest_term_ = std::max(newest_term_, obeyed_term_);
  if (role_ == Role::kActive) {
    if (another_flies(obeyed)) step_down(obeyed.term);
  } else if (silence_ns_ > patience_ns(obeyed, now_ns) && !is_on_trial()) {
    take_over(stamp_ns, obeyed, now_ns);
  }
  watch_takeover(stamp_ns, obeyed);
  return role_;
}

// By the samples up to now the vehicle obeyed this controller last, and not long ago. If it hears another one, the next
// samples say so.
bool Failover::flies(std::int64_t now_ns) const {
  return obeyed_term_ == own_term_ && silence_ns_ <= kTrialNs && now_ns - last_now_ns_ <= kTrialNs;
}

// Another one took over, or the one that was taken for dead goes on and the vehicle has not heard this one.
bool Failover::another_flies(const plant::ObeyedCommand& obeyed) const {
  if (!obeyed.any || silence_ns_ > least_patience_ns(obeyed)) return false;
  const bool unheard = takeover_state_ == TakeoverState::kWatched && obeyed.term != own_term_ &&
                       obeyed.stamp_ns - taken_over_ns_ > kPatienceNs;
  return obeyed.term > own_term_ || unheard;
}

void Failover::take_over(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns) {
  continues_ = knows_flight(now_ns);
  takeover_ = {silence_ns_,
               patience_ns(obeyed, now_ns),
               loop_delay_.figures().p95_ns,
               rank(now_ns),
               continues_,
               silence_ns_,
               longest_pause_ns_};
  taken_over_ns_ = stamp_ns;
  const bool from_another = obeyed_term_ != 0 || followed_term_ != 0;
  takeover_state_ = from_another ? TakeoverState::kWatched : TakeoverState::kNone;
  own_term_ = next_term();
  newest_term_ = own_term_;
  role_ = Role::kActive;
}

void Failover::watch_takeover(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed) {
  if (takeover_state_ != TakeoverState::kWatched) return;
  takeover_.obeyed = obeyed.any && obeyed.term == own_term_;
  if (!takeover_.obeyed) {
    takeover_.longest_silence_ns = std::max(takeover_.longest_silence_ns, silence_ns_);
    takeover_.longest_pause_ns = std::max(takeover_.longest_pause_ns, longest_pause_ns_);
  }
  const bool is_over = takeover_.obeyed || !obeyed.any || role_ != Role::kActive ||
                       stamp_ns < taken_over_ns_ || stamp_ns - taken_over_ns_ > kTrialNs;
  if (is_over) takeover_state_ = TakeoverState::kComplete;
}

bool Failover::take_takeover(Takeover& takeover) {
  if (takeover_state_ != TakeoverState::kComplete) return false;
  takeover_state_ = TakeoverState::kNone;
  takeover = takeover_;
  return true;
}

void Failover::pass_time(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns) {
  const std::int64_t elapsed_ns = sampled_ ? stamp_ns - last_stamp_ns_ : 0;
  const std::int64_t waited_ns = sampled_ ? now_ns - last_now_ns_ : 0;
  const std::int64_t silent_before_ns = silence_ns_;
  if (obeyed.any) {
    silence_ns_ = stamp_ns - obeyed.stamp_ns;
  } else if (elapsed_ns < 0) {
    silence_ns_ = 0;  // the vehicle was restarted
  } else {
    // A burst of samples that waited for this process adds next to nothing.
    silence_ns_ += std::min({elapsed_ns, waited_ns, kMaxStepNs});
  }
  longest_pause_ns_ = silence_ns_ > silent_before_ns ? std::max(longest_pause_ns_, waited_ns) : waited_ns;
  followed_for_ns_ += std::clamp<std::int64_t>(elapsed_ns, 0, kMaxStepNs);
  sampled_ = true;
  last_stamp_ns_ = stamp_ns;
  last_now_ns_ = now_ns;
}

bool Failover::knows_flight(std::int64_t now_ns) const {
  const bool obeyed = obeyed_term_ == 0 || obeyed_term_ == followed_term_;
  return followed_term_ != 0 && obeyed && now_ns - followed_heard_ns_ < kForgottenNs;
}

bool Failover::is_on_trial() const {
  return obeyed_term_ != 0 && obeyed_term_ < followed_term_ && followed_for_ns_ < kTrialNs;
}

std::int64_t Failover::least_patience_ns(const plant::ObeyedCommand& obeyed) const {
  const std::int64_t delay_ns = loop_delay_.figures().p95_ns;
  if (obeyed.any && delay_ns < 0) return kUnknownDelayNs;
  return std::clamp(delay_ns + kBeyondDelayNs, kPatienceNs, kUnknownDelayNs);
}

std::int64_t Failover::patience_ns(const plant::ObeyedCommand& obeyed, std::int64_t now_ns) const {
  const std::int64_t turn_ns = rank(now_ns) * kPerRankNs;
  if (knows_flight(now_ns)) return least_patience_ns(obeyed) + turn_ns;
  return std::max(obeyed.reported ? kUnknownFlightPatienceNs : kSearchNs, least_patience_ns(obeyed)) +
         turn_ns;
}

// The number of standbys that rank before this one.
int Failover::rank(std::int64_t now_ns) const {
  return static_cast<int>(std::count_if(peers_.begin(), peers_.end(), [&](const Heartbeat& peer) {
    const bool waits =
        peer.controller != 0 && peer.role == Role::kStandby && now_ns - peer.heard_ns < kForgottenNs;
    return waits && (peer.failover_priority > failover_priority_ ||
                     (peer.failover_priority == failover_priority_ && peer.controller > controller_));
  }));
}

}  // namespace swiftlet::services
