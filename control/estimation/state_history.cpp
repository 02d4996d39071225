#include "swiftlet/control/estimation/state_history.hpp"

#include <algorithm>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Longest interval of one covariance propagation, in which F takes f and R as constant.
constexpr std::int64_t kInterval_ns = 20'000'000;

// Weighted mean of two attitudes that are close to each other, whatever the signs of the quaternions.
Quaterniond mean(const Quaterniond& a, double part_a, const Quaterniond& b, double part_b) {
  const double sign = a.dot(b) < 0.0 ? -1.0 : 1.0;
  return Quaterniond((part_a * a.coeffs() + sign * part_b * b.coeffs()).eval()).normalized();
}

// The motion from one state to another, also back in time. Leaves r_ned_from_frd out.
ErrorInterval change_between(const NominalState& from, const NominalState& to) {
  ErrorInterval out;
  out.duration_s = math::seconds(to.stamp_ns - from.stamp_ns);
  const Vector3d fall = {0.0, 0.0, out.duration_s * plant::kGravity};
  out.velocity_change = to.velocity_ned - from.velocity_ned - fall;
  out.position_change =
      to.position_ned - from.position_ned - out.duration_s * (from.velocity_ned + 0.5 * fall);
  return out;
}

}  // namespace

void StateHistory::append(const NominalState& state) {
  newest_ = state;
  Entry& entry = entries_[next_++ % kCapacity];
  entry.state = state;
  entry.corrections = corrections_made_;
}

void StateHistory::begin_at(const NominalState& start) {
  first_after_anchor_ = next_ - std::min<std::uint64_t>(next_, kCapacity);
  anchor_ = entry(first_after_anchor_).state;
  const std::uint64_t first_newer = first_newer_than(start.stamp_ns);
  const NominalState propagated =
      start.stamp_ns > anchor_.stamp_ns ? place_at(start.stamp_ns).state : anchor_;
  const Quaterniond turn = start.q_ned_from_frd * propagated.q_ned_from_frd.conjugate();
  const auto shift_to_start = [&](NominalState& state) {
    const ErrorInterval since = change_between(propagated, state);
    const double t = math::seconds(state.stamp_ns - start.stamp_ns);
    const Vector3d fall(0.0, 0.0, t * plant::kGravity);
    state.position_ned = start.position_ned + 0.5 * t * fall + turn * since.position_change;
    state.velocity_ned = fall + turn * since.velocity_change;
    state.q_ned_from_frd = (turn * state.q_ned_from_frd).normalized();
  };
  for (std::uint64_t number = first_newer; number < next_; ++number)
    shift_to_start(entries_[number % kCapacity].state);
  shift_to_start(newest_);
  anchor_ = start;
  first_after_anchor_ = first_newer;
}

void StateHistory::apply(const ErrorState& step) {
  const Eigen::Matrix3d r = anchor_.q_ned_from_frd.toRotationMatrix();
  if (next_ > first_after_anchor_ &&
      corrections_made_ - entry(first_after_anchor_).corrections >= kCorrections)
    correct_entries();
  Correction& correction = corrections_[corrections_made_++ % kCorrections];
  correction.at = anchor_;
  correction.position = step.segment<3>(0);
  correction.velocity = step.segment<3>(3);
  correction.rotation = step.segment<3>(6);
  correction.rate = r * step.segment<3>(9);
  correction.acceleration = r * step.segment<3>(12);
  correction.apply_to(anchor_);
  correction.apply_to(newest_);
}

// F of error_covariance.hpp, with the attitude step as a rotation: Sola's Eq. (314c), q <- rotation(step) q.
// The covariance's reset, Eq. (316) and (317), P <- G P G' with G = I + [step / 2]x, is left out: G differs
// from I by half a step of attitude, some mrad.
void StateHistory::Correction::apply_to(NominalState& state) const {
  const ErrorInterval since = change_between(at, state);
  const double t = since.duration_s;
  state.position_ned += position + t * velocity - since.position_change.cross(rotation - (t / 3) * rate) -
                        (t * t / 2) * acceleration;
  state.velocity_ned += velocity - since.velocity_change.cross(rotation - (t / 2) * rate) - t * acceleration;
  state.q_ned_from_frd = (math::rotation(rotation - t * rate) * state.q_ned_from_frd).normalized();
}

NominalState StateHistory::state(std::uint64_t number) const {
  NominalState corrected = entry(number).state;
  for (std::uint64_t i = entry(number).corrections; i < corrections_made_; ++i)
    corrections_[i % kCorrections].apply_to(corrected);
  return corrected;
}

// Before a correction is overwritten that they need.
void StateHistory::correct_entries() {
  for (std::uint64_t number = first_after_anchor_; number < next_; ++number)
    entries_[number % kCapacity] = {state(number), corrections_made_};
}

// The number of the first entry after the anchor and after this stamp.
std::uint64_t StateHistory::first_newer_than(std::int64_t stamp_ns) const {
  std::uint64_t first_newer = next_;
  while (first_newer > first_after_anchor_ && this->stamp_ns(first_newer - 1) > stamp_ns) --first_newer;
  return first_newer;
}

StateHistory::Place StateHistory::place_at(std::int64_t stamp_ns) const {
  stamp_ns = std::min(stamp_ns, newest_.stamp_ns);
  const std::uint64_t first_newer = first_newer_than(stamp_ns);
  Place place{first_newer > first_after_anchor_ ? state(first_newer - 1) : anchor_, first_newer};
  const NominalState before = place.state;
  if (before.stamp_ns == stamp_ns) return place;
  const NominalState after = state(first_newer);
  const double part =
      math::seconds(stamp_ns - before.stamp_ns) / math::seconds(after.stamp_ns - before.stamp_ns);
  place.state.stamp_ns = stamp_ns;
  place.state.position_ned += part * (after.position_ned - before.position_ned);
  place.state.velocity_ned += part * (after.velocity_ned - before.velocity_ned);
  place.state.q_ned_from_frd = mean(before.q_ned_from_frd, 1.0 - part, after.q_ned_from_frd, part);
  return place;
}

// The end of the interval that begins at `from`: the last state within kInterval_ns, or across a gap the next one; at most `to`.
StateHistory::Place StateHistory::next_place(const Place& from, const Place& to) const {
  const std::int64_t end_ns = from.state.stamp_ns + kInterval_ns;
  if (end_ns >= to.state.stamp_ns || from.next >= next_) return to;
  std::uint64_t last = from.next;
  while (last + 1 < next_ && stamp_ns(last + 1) <= end_ns) ++last;
  if (stamp_ns(last) >= to.state.stamp_ns) return to;
  return {state(last), last + 1};
}

ErrorInterval StateHistory::interval(const NominalState& from, const NominalState& to) {
  ErrorInterval out = change_between(from, to);
  out.r_ned_from_frd = mean(from.q_ned_from_frd, 0.5, to.q_ned_from_frd, 0.5).toRotationMatrix();
  return out;
}

}  // namespace swiftlet::control
