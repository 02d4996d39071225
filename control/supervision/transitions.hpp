// The modes' one state machine, as a table. Conditions are looked at in every step, and of all rows that fit,
// the first is taken. Of a request, the first row that fits answers; where none does, it is refused.
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

// Where a transition leads: to a mode, or nowhere else.
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
  const Precondition& provided;  // of requests
  Target to;
  Reason reason;  // unless it stays
  const Action& action;
};

struct TransitionTable {
  const Transition* rows;
  int count;
  const Transition* begin() const { return rows; }
  const Transition* end() const { return rows + count; }
};
TransitionTable transitions();

// The row that the conditions of a step ask for; null if none does.
const Transition* find(const SupervisorContext& context, const EventSet& conditions);
// The row that answers a request; null if none does.
const Transition* find(const SupervisorContext& context, Event request);

// Why a request is refused that no row answers.
Outcome refusal(Event request, const SupervisorContext& context);

}  // namespace swiftlet::control
