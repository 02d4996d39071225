// The state machine of the modes, as a table. Conditions are evaluated in every step: the first row that
// applies is taken. A request is answered by the first row that applies, and refused if none does.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "swiftlet/control/supervision/actions.hpp"
#include "swiftlet/control/supervision/events.hpp"
#include "swiftlet/control/supervision/guards.hpp"
#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::control {

constexpr int kModeCount = static_cast<int>(Mode::kStopped) + 1;

class ModeSet {
 public:
  constexpr ModeSet(std::initializer_list<Mode> modes) {
    for (const Mode mode : modes) bits_ |= bit(mode);
  }
  constexpr bool has(Mode mode) const { return (bits_ & bit(mode)) != 0; }
  constexpr bool operator==(const ModeSet& other) const { return bits_ == other.bits_; }

 private:
  static constexpr unsigned bit(Mode mode) { return 1U << static_cast<unsigned>(mode); }
  unsigned bits_ = 0;
};

// The target of a transition: another mode, or none.
struct Target {
  constexpr Target(Mode to) : mode(to), stays(false) {}  // NOLINT(google-explicit-constructor)
  constexpr static Target stay() { return Target(); }
  Mode mode = Mode::kDisarmed;
  bool stays = true;

 private:
  constexpr Target() = default;
};
constexpr Target kStay = Target::stay();

struct Transition {
  ModeSet from;
  Event event;
  const Guard& guards;
  const Precondition& provided;  // requests only
  Target to;
  Reason reason;  // unused without a change of mode
  const Action& action;
};

struct TransitionTable {
  const Transition* rows;
  int count;
  const Transition* begin() const { return rows; }
  const Transition* end() const { return rows + count; }
};
TransitionTable transitions();

// The row for the conditions of a step; null if none applies.
const Transition* find(const SupervisorContext& context, const EventSet& conditions);
// The row that answers a request; null if none applies.
const Transition* find(const SupervisorContext& context, Event request);

// The refusal of a request to which no row applies.
Outcome refusal(Event request, const SupervisorContext& context);

}  // namespace swiftlet::control
