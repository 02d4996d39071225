// Which of several controllers of one vehicle acts, and which one follows when it falls silent. Pure: what is
// heard and when goes in, a role comes out.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::services {

enum class Role : std::uint8_t {
  kStandby = 0,  // follows and sends no commands
  kActive = 1,   // flies the vehicle
};
const char* to_string(Role role);

// A sign of life of a controller.
struct Heartbeat {
  std::uint64_t controller = 0;  // its number, random
  int failover_priority = 0;     // 0 .. 1000
  std::uint32_t term = 0;        // of an active one: of its commands; else the newest that it knows of
  Role role = Role::kStandby;
  std::int64_t heard_ns = 0;  // monotonic
};

// The acting controller's commands carry its term; each takeover begins a higher one, so that whoever was
// overtaken, perhaps while it was stopped, is told from whoever flies. The vehicle says with each IMU sample
// which term it obeyed last and for which sample: that alone decides whether somebody flies it, in the
// vehicle's time, so that a controller that was held up itself takes nobody for dead. With a vehicle that
// says nothing, the heartbeats of the active controller decide.
//
// One thread calls it. Nothing in it allocates.
class Failover {
 public:
  Failover(std::uint64_t controller, int failover_priority);

  void heard(const Heartbeat& beat);

  // With each IMU sample, before it is answered: the role in which to answer. now_ns: monotonic.
  Role sample(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns);

  Role role() const { return role_; }
  std::uint32_t term() const { return role_ == Role::kActive ? own_term_ : newest_term_; }
  // The term that a takeover would begin; higher than all that are known.
  std::uint32_t next_term() const;
  // Of the active one that is followed; 0 before it was heard.
  std::uint32_t followed_term() const { return followed_term_; }
  // At the last takeover the one before had been heard to the end: its flight can be gone on with.
  bool continues() const { return continues_; }

  // Silence of the vehicle's active controller, in the vehicle's time, after which a standby takes over: the
  // first in rank after kPatience, each after it kPerRank later. One that does not know the flight leaves
  // time to those that do.
  static constexpr std::int64_t kPatienceNs = 25'000'000;
  static constexpr std::int64_t kPerRankNs = 15'000'000;
  static constexpr std::int64_t kStrangersPatienceNs = 100'000'000;
  // Where the vehicle does not say whom it obeys: time to find an active controller that may be there.
  static constexpr std::int64_t kSearchNs = 1'000'000'000;
  // The vehicle has not obeyed the last takeover, perhaps nobody: so long the one that took over is left to
  // try.
  static constexpr std::int64_t kTrialNs = 500'000'000;
  // A standby that was not heard for so long has no rank; an active one can no longer be gone on from.
  static constexpr std::int64_t kForgottenNs = 1'000'000'000;

 private:
  static constexpr std::size_t kMaxPeers = 16;

  void note(const Heartbeat& beat);
  void step_down(std::uint32_t to_term);
  void pass_time(std::int64_t stamp_ns, const plant::ObeyedCommand& obeyed, std::int64_t now_ns);
  bool knows_flight(std::int64_t now_ns) const;
  bool is_on_trial() const;
  std::int64_t patience_ns(const plant::ObeyedCommand& obeyed, std::int64_t now_ns) const;
  int rank(std::int64_t now_ns) const;

  std::uint64_t controller_;
  int failover_priority_;
  Role role_ = Role::kStandby;
  std::uint32_t own_term_ = 0;
  std::uint32_t newest_term_ = 0;  // of all that were heard of
  std::uint32_t obeyed_term_ = 0;  // by the vehicle; 0: it obeyed none, or does not say
  std::uint32_t followed_term_ = 0;
  std::int64_t followed_heard_ns_ = 0;
  std::int64_t followed_for_ns_ = 0;  // the vehicle's time
  bool continues_ = false;

  bool sampled_ = false;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_now_ns_ = 0;
  std::int64_t silence_ns_ = 0;
  std::array<Heartbeat, kMaxPeers> peers_{};  // controller 0: free
};

}  // namespace swiftlet::services
