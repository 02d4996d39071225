// Decides which of several controllers of one vehicle is active, and which standby takes over when the active
// one falls silent. Pure: heartbeats, samples and times in, the role out.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/control/loop_delay.hpp"
#include "swiftlet/services/control/takeover.hpp"

namespace swiftlet::services {

enum class Role : std::uint8_t {
  kStandby = 0,  // follows the active controller, sends no commands
  kActive = 1,   // flies the vehicle
};
const char* to_string(Role role);

// A controller's heartbeat, received in controller_state.
struct Heartbeat {
  std::uint64_t controller = 0;  // its random number
  int failover_priority = 0;     // 0 .. 1000
  std::uint32_t term = 0;        // active: of its commands; standby: the newest term it knows
  Role role = Role::kStandby;
  std::int64_t heard_ns = 0;  // monotonic
};

// The active controller's commands carry its term. Each takeover begins a higher term, which distinguishes
// the active controller from one that was overtaken, for example while its process was stopped. The vehicle
// reports with each IMU sample the term that it obeyed last, and for which sample. This report alone decides
// whether the vehicle has an active controller. Silence is measured on the vehicle's clock, so that a
// controller that was itself delayed does not consider the active one dead. If the vehicle does not report,
// the heartbeats of the active controller decide.
//
// Not thread-safe. Does not allocate.
class Failover {
 public:
  Failover(std::uint64_t controller, int failover_priority);

  void heard(const Heartbeat& beat);

  // Call with each IMU sample before answering it. Returns the role in which to answer. now_ns: monotonic.
  Role sample(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns);

  Role role() const { return role_; }
  std::uint32_t term() const { return role_ == Role::kActive ? own_term_ : newest_term_; }
  // The term that a takeover would begin; higher than all known terms.
  std::uint32_t next_term() const;
  // The term of the active controller that is followed; 0 before its first heartbeat.
  std::uint32_t followed_term() const { return followed_term_; }
  const LoopDelay& loop_delay() const { return loop_delay_; }
  // True if the state of the previous controller was known up to the last takeover: the flight continues from
  // it.
  bool continues() const { return continues_; }

  // Returns true once for each takeover from another controller, when it is known when the vehicle obeyed it.
  bool take_takeover(Takeover& takeover);

  // Silence of the active controller, on the vehicle's clock, after which a standby takes over: the first in
  // rank after kPatienceNs, each further one kPerRankNs later. A standby that does not know the state of the
  // flight waits for kUnknownFlightPatienceNs: those that know it take over first. Over a slow network
  // commands are always old: the first one waits at least kBeyondDelayNs longer than 95 % of them need, but at
  // most kUnknownDelayNs, and that long while it is not measured.
  static constexpr std::int64_t kPatienceNs = 25'000'000;
  static constexpr std::int64_t kBeyondDelayNs = 15'000'000;
  static constexpr std::int64_t kUnknownDelayNs = 250'000'000;
  static constexpr std::int64_t kPerRankNs = 15'000'000;
  static constexpr std::int64_t kUnknownFlightPatienceNs = 100'000'000;
  // The same if the vehicle does not report which term it obeys: time to discover an active controller.
  static constexpr std::int64_t kSearchNs = 1'000'000'000;
  // After a takeover that the vehicle has not obeyed yet, no other standby takes over for this long, on the
  // vehicle's clock.
  static constexpr std::int64_t kTrialNs = 500'000'000;
  // A standby silent for this long is not ranked; the flight of an active controller silent for this long
  // cannot be continued.
  static constexpr std::int64_t kForgottenNs = 1'000'000'000;

 private:
  static constexpr std::size_t kMaxPeers = 16;

  void note(const Heartbeat& beat);
  void step_down(std::uint32_t to_term);
  bool flies(std::int64_t now_ns) const;
  bool another_flies(const plant::ObeyedCommand& obeyed) const;
  void pass_time(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns);
  bool knows_flight(std::int64_t now_ns) const;
  bool is_on_trial() const;
  std::int64_t least_patience_ns(const plant::ObeyedCommand& obeyed) const;
  std::int64_t patience_ns(const plant::ObeyedCommand& obeyed, std::int64_t now_ns) const;
  int rank(std::int64_t now_ns) const;
  void take_over(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns);
  void watch_takeover(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed);

  std::uint64_t controller_;
  int failover_priority_;
  Role role_ = Role::kStandby;
  std::uint32_t own_term_ = 0;
  std::uint32_t newest_term_ = 0;  // of all known terms
  std::uint32_t obeyed_term_ = 0;  // by the vehicle; 0: none, or not reported
  std::uint32_t followed_term_ = 0;
  std::int64_t followed_heard_ns_ = 0;
  std::int64_t followed_for_ns_ = 0;  // vehicle's clock
  bool continues_ = false;

  enum class TakeoverState { kNone, kWatched, kComplete };
  Takeover takeover_;
  std::int64_t taken_over_ns_ = 0;  // vehicle's clock
  TakeoverState takeover_state_ = TakeoverState::kNone;

  LoopDelay loop_delay_;
  bool sampled_ = false;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_now_ns_ = 0;
  std::int64_t silence_ns_ = 0;
  std::int64_t longest_pause_ns_ = 0;         // between two samples in this silence, monotonic
  std::array<Heartbeat, kMaxPeers> peers_{};  // controller 0: unused entry
};

}  // namespace swiftlet::services
