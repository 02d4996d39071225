// Runs the transition table: every mode with every event, every guard at its limit, all failsafes at once.
#include "swiftlet/control/supervision/transitions.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/types/gains.hpp"
#include "tests/unit/control/placed_flight.hpp"

namespace swiftlet::control::transitions_test {

// The columns of the grid below. A small letter is a situation within a mode.
struct Place {
  char letter;
  const char* name;
  Mode mode;
  std::function<bool(Placed&)> reach;
};

const std::vector<Place>& places() {
  static const std::vector<Place> kPlaces = {
      {'D', "disarmed", Mode::kDisarmed, [](Placed&) { return true; }},
      {'A', "armed", Mode::kArmed, [](Placed& f) { return f.ask(RequestKind::kArm).accepted; }},
      {'t', "taking off, on the ground", Mode::kTakingOff,
       [](Placed& f) {
         f.ask(RequestKind::kArm);
         return f.ask(RequestKind::kTakeoff, {0, 0, -1}).accepted;
       }},
      {'T', "taking off", Mode::kTakingOff,
       [](Placed& f) {
         f.ask(RequestKind::kArm);
         return f.ask(RequestKind::kTakeoff, {0, 0, -1}).accepted &&
                f.step_until([&] { return f.supervisor_.airborne(); }, 5.0);
       }},
      {'H', "holding", Mode::kHolding, [](Placed& f) { return f.take_off(); }},
      {'m', "mission, on the ground", Mode::kMission,
       [](Placed& f) { return f.ask(RequestKind::kArm).accepted && f.fly(f.mission_).accepted; }},
      {'M', "mission", Mode::kMission,
       [](Placed& f) { return f.take_off() && f.fly(f.two_places_).accepted; }},
      {'l', "mission, at its landing", Mode::kMission,
       [](Placed& f) {
         return f.ask(RequestKind::kArm).accepted && f.fly(f.mission_).accepted &&
                f.step_until([&] { return f.supervisor_.mission().item_index == 2; }, 20.0);
       }},
      {'J', "trajectory", Mode::kTrajectory,
       [](Placed& f) { return f.take_off() && f.fly(f.trajectory_).accepted; }},
      {'S', "setpoint", Mode::kSetpoint,
       [](Placed& f) {
         return f.take_off() && f.stream({0, 0, -1}).accepted;
       }},
      {'L', "landing", Mode::kLanding,
       [](Placed& f) { return f.take_off() && f.ask(RequestKind::kLand).accepted; }},
      {'W', "descent without position", Mode::kDescent,
       [](Placed& f) {
         const bool up = f.take_off();
         f.inputs_.pose_age_s = 1.0;
         f.step();
         return up;
       }},
      {'O', "stopped", Mode::kStopped, [](Placed& f) { return f.ask(RequestKind::kStop).accepted; }},
      {'P', "mission paused", Mode::kHolding,
       [](Placed& f) {
         return f.take_off() && f.fly(f.two_places_).accepted && f.ask(RequestKind::kMissionPause).accepted;
       }},
  };
  return kPlaces;
}

Mode mode_of(char letter) {
  for (const Place& place : places()) {
    if (place.letter == letter) return place.mode;
  }
  ADD_FAILURE() << "no mode has the letter " << letter;
  return Mode::kDisarmed;
}

// Triggers an event; returns the outcome of a request.
using Cause = std::function<std::optional<Outcome>(Placed&)>;

Cause condition(const std::function<void(Placed&)>& change) {
  return [change](Placed& flight) {
    change(flight);
    flight.step();
    return std::nullopt;
  };
}
Cause lasting(double seconds, const std::function<void(Placed&)>& change) {
  return [seconds, change](Placed& flight) {
    change(flight);
    const Mode before = flight.mode();
    flight.step_until([&] { return flight.mode() != before; }, seconds);
    return std::nullopt;
  };
}
Cause request(RequestKind kind) {
  return [kind](Placed& flight) -> std::optional<Outcome> {
    const Mission& mission = flight.mode() == Mode::kArmed ? flight.mission_ : flight.two_places_;
    if (kind == RequestKind::kMissionUpload) return flight.upload(mission);
    if (kind == RequestKind::kMissionStart) flight.upload(mission);
    if (kind == RequestKind::kTrajectory) return flight.fly(flight.trajectory_);
    return flight.ask(kind, {0, 0, -1});
  };
}

Cause change_gains() {
  return [](Placed& flight) {
    const GainChange change;
    Request request = flight.next_request(RequestKind::kSettings);
    request.gains = &change;
    return std::optional(flight.supervisor_.request(request, flight.inputs_));
  };
}

// A row of the grid: for each place, the mode that follows. ".": nothing happens; "=": accepted, and the mode
// stays; "x": refused; " ": cannot happen there.
struct Row {
  Event event;
  GroundLinkAction link;
  const char* next;  // in the order of places()
  Reason reason;
  Cause cause;
};
void PrintTo(const Row& row, std::ostream* out) { *out << to_string(row.event); }

const Row kGrid[] = {
    // clang-format off
    //                              DAtTHmMlJSLWOP
    {Event::kVehicleRestarted, kLand, ".OOOOOOOOOOO.O", Reason::kVehicleRestarted, condition([](Placed& f) { f.inputs_.vehicle_restarted = true; })},
    {Event::kImuUnusable, kLand,   ".OOOOOOOOOOO.O", Reason::kImuUnusable, condition([](Placed& f) { f.inputs_.imu_unusable_s = 0.1; })},
    {Event::kImuGap, kLand,        ".OOOOOOOOOOO.O", Reason::kImuGap, condition([](Placed& f) { f.inputs_.imu_gap_s = 0.4; })},
    {Event::kTippedOver, kLand,    ".OOOOOOOOOOO.O", Reason::kTippedOver, condition([](Placed& f) { f.estimate_.q_ned_from_frd = Eigen::AngleAxisd(1.5, Vector3d::UnitX()); })},
    {Event::kVehicleFault, kLand,  ".OOOOOOOOOOO.O", Reason::kVehicleFault, condition([](Placed& f) { f.inputs_.vehicle_fault_s = 0.5; })},
    {Event::kRotorsNotRunning, kLand, "  D  D        ", Reason::kRotorsNotRunning, lasting(10.1, [](Placed& f) { f.inputs_.rotors_running = false; })},
    {Event::kNotObeyed, kLand,     " DD  D        ", Reason::kNotObeyed, lasting(1.1, [](Placed& f) { f.inputs_.not_obeyed_s = 2.0; })},
    {Event::kNoLiftOff, kLand,     "  D  D        ", Reason::kNoLiftOff, lasting(6.0, [](Placed& f) { f.follows_ = false; })},
    {Event::kHoverTestFailed, kLand, "..............", Reason::kHoverTestFailed, condition([](Placed& f) { f.inputs_.hover_test_defect = "not in a hover test"; })},
    {Event::kHoverTestPassed, kLand, "    .         ", Reason::kHoverTestPassed, lasting(3.0, [](Placed&) {})},
    {Event::kImpact, kLand,        "..OOOOO OO  .O", Reason::kImpact, condition([](Placed& f) { f.inputs_.specific_force_frd.z() = -120.0; })},
    {Event::kImpact, kLand,        "       D  D   ", Reason::kLanded, condition([](Placed& f) { f.inputs_.specific_force_frd.z() = -120.0; })},
    {Event::kImpact, kLand,        "           D  ", Reason::kLandedWithoutPosition, condition([](Placed& f) { f.inputs_.specific_force_frd.z() = -120.0; })},
    {Event::kTakeoffInconsistent, kLand,  "...OO.OOOOO..O", Reason::kTakeoffInconsistent, condition([](Placed& f) { f.inputs_.takeoff_inconsistent = true; })},
    {Event::kPoseJumped, kLand,    ".DDLLDLLLL.L.L", Reason::kPoseJumped, condition([](Placed& f) { f.inputs_.pose_jumped = true; })},
    {Event::kPoseLost, kLand,      ".DDWWDWWWWW..W", Reason::kNoPose, condition([](Placed& f) { f.inputs_.pose_age_s = 0.6; })},
    {Event::kPoseIsBack, kLand,    "...........H..", Reason::kPoseIsBack, condition([](Placed& f) { f.inputs_.pose_age_s = 0.0; })},
    {Event::kTouchdown, kLand,    "       D  D   ", Reason::kLanded, lasting(20.0, [](Placed&) {})},
    {Event::kTouchdown, kLand,    "           D  ", Reason::kLandedWithoutPosition, lasting(0.4, [](Placed& f) { f.inputs_.vertical_specific_force_residual = 2.0; })},
    {Event::kDescentTimedOut, kLand, "           O  ", Reason::kDescentTimedOut, lasting(6.1, [](Placed&) {})},
    {Event::kBatteryCritical, kLand, "..DLLDLLLLL..L", Reason::kBatteryCritical, condition([](Placed& f) { f.inputs_.supply_voltage_v = 3.0; })},
    {Event::kOutsideFence, kLand,  "..DLLDLLLL...L", Reason::kOutsideFence, condition([](Placed& f) { f.estimate_.position_ned.x() = 3.3; })},
    {Event::kBatteryLow, kLand,    "..DLLDLLLL...L", Reason::kBatteryLow, condition([](Placed& f) { f.inputs_.supply_voltage_v = 3.2; })},
    {Event::kBatterySilent, kLand, "..DLLDLLLL...L", Reason::kBatterySilent, condition([](Placed& f) { f.inputs_.battery_age_s = 2.1; })},
    {Event::kGroundLinkLost, kLand, ".DDLLDLLLL...L", Reason::kGroundLinkLost, condition([](Placed& f) { f.lose_ground_link(); })},
    {Event::kGroundLinkLost, GroundLinkAction::kHold, ".DDHHDHHHH...H", Reason::kGroundLinkLost, condition([](Placed& f) { f.lose_ground_link(); })},
    {Event::kGroundLinkLost, GroundLinkAction::kNone, "..............", Reason::kGroundLinkLost, condition([](Placed& f) { f.lose_ground_link(); })},
    {Event::kSetpointsStopped, kLand, "         H    ", Reason::kSetpointsStopped, lasting(0.85, [](Placed&) {})},
    {Event::kSetpointsViolateFence, kLand, "    H    H    ", Reason::kSetpointsViolatedFence, condition([](Placed& f) { f.tilt(); f.estimate_.position_ned.x() = 2.9; f.estimate_.velocity_ned.x() = 1.0; })},
    {Event::kPlanFinished, kLand,  "   H          ", Reason::kTakeOffCompleted, lasting(10.0, [](Placed&) {})},
    {Event::kPlanFinished, kLand,  "      H       ", Reason::kMissionCompleted, lasting(10.0, [](Placed&) {})},
    {Event::kPlanFinished, kLand,  "        H     ", Reason::kTrajectoryCompleted, lasting(10.0, [](Placed&) {})},
    {Event::kStop, kLand,          "OOOOOOOOOOOOOO", Reason::kRequested, request(RequestKind::kStop)},
    {Event::kArm, kLand,           "A=xxxxxxxxxxxx", Reason::kRequested, request(RequestKind::kArm)},
    {Event::kDisarm, kLand,        "DDDxxDxxxxxxDx", Reason::kRequested, request(RequestKind::kDisarm)},
    {Event::kTakeoff, kLand,       "xTxxxxxxxxxxxx", Reason::kRequested, request(RequestKind::kTakeoff)},
    {Event::kHoverTest, kLand,     "xTxxxxxxxxxxxx", Reason::kHoverTest, request(RequestKind::kHoverTest)},
    {Event::kMissionUpload, kLand, "=====xxx=====x", Reason::kRequested, request(RequestKind::kMissionUpload)},
    {Event::kMissionStart, kLand,  "xMxxMxxxxxxxxx", Reason::kRequested, request(RequestKind::kMissionStart)},
    {Event::kMissionPause, kLand,  "xxxxxxHxxxxxxx", Reason::kMissionPaused, request(RequestKind::kMissionPause)},
    {Event::kMissionResume, kLand, "xxxxxxxxxxxxxM", Reason::kRequested, request(RequestKind::kMissionResume)},
    {Event::kMissionSkip, kLand,   "xxxxxx=xxxxxxM", Reason::kRequested, request(RequestKind::kMissionSkip)},
    {Event::kMissionClear, kLand,  "=====xxx======", Reason::kRequested, request(RequestKind::kMissionClear)},
    {Event::kTrajectory, kLand,    "xxxxJxxx=JxxxJ", Reason::kRequested, request(RequestKind::kTrajectory)},
    {Event::kSettings, kLand,      "==xx=x=x==xx==", Reason::kRequested, change_gains()},
    {Event::kSetpoint, kLand,      "xxxxSxxxx=xxxS", Reason::kSetpointsCame, [](Placed& f) { return std::optional(f.stream(f.estimate_.position_ned)); }},
    {Event::kGoTo, kLand,          "xxxHHxHHHHHxxH", Reason::kRequested, request(RequestKind::kGoTo)},
    {Event::kHold, kLand,          "xxxHHxHHHHHxxH", Reason::kRequested, request(RequestKind::kHold)},
    {Event::kLand, kLand,          "xxDLLDLLLL==xL", Reason::kRequested, request(RequestKind::kLand)},
    {Event::kPlanUnknown, kLand,   ".....DHHH....H", Reason::kPlanUnknown, [](Placed& f) { f.forget_plan(); return std::optional<Outcome>(); }},
    {Event::kEngagedInFlight, kLand,   "Hxxxxxxxxxxxxx", Reason::kEngagedInFlight, [](Placed& f) { return std::optional(f.supervisor_.engage_in_flight(f.inputs_)); }},
    // clang-format on
};

class Grid : public testing::TestWithParam<Row> {};

TEST_P(Grid, EveryModeReactsAsListed) {
  const Row& row = GetParam();
  ASSERT_EQ(std::string(row.next).size(), places().size());
  for (std::size_t i = 0; i < places().size(); ++i) {
    const Place& place = places()[i];
    const char next = row.next[i];
    if (next == ' ') continue;
    SCOPED_TRACE(std::string(place.name) + ", " + to_string(row.event));
    Placed flight(row.link);
    ASSERT_TRUE(place.reach(flight));
    ASSERT_EQ(flight.mode(), place.mode);
    const Reason before = flight.supervisor_.reason();
    const std::optional<Outcome> outcome = row.cause(flight);
    if (outcome) {
      EXPECT_EQ(outcome->accepted, next != 'x') << outcome->reason;
      EXPECT_EQ(outcome->reason[0] == '\0', next != 'x') << "a refusal has a reason, nothing else has one";
    }
    const bool moves = std::string(".=x").find(next) == std::string::npos;
    EXPECT_EQ(flight.mode(), moves ? mode_of(next) : place.mode)
        << "went to " << to_string(flight.mode()) << ": " << to_string(flight.supervisor_.reason());
    EXPECT_EQ(flight.supervisor_.reason(), moves ? row.reason : before);
  }
}

INSTANTIATE_TEST_SUITE_P(Events, Grid, testing::ValuesIn(kGrid));

TEST(GridItself, CoversEveryEventAndMode) {
  for (int i = 0; i < kEventCount; ++i) {
    const auto event = static_cast<Event>(i);
    EXPECT_TRUE(std::any_of(std::begin(kGrid), std::end(kGrid), [&](const Row& row) {
      return row.event == event;
    })) << to_string(event);
  }
  for (int i = 0; i < kModeCount; ++i) {
    const auto mode = static_cast<Mode>(i);
    EXPECT_TRUE(std::any_of(places().begin(), places().end(), [&](const Place& place) {
      return place.mode == mode;
    })) << to_string(mode);
  }
}

TEST(Transitions, NoRowHidesALaterRow) {
  const TransitionTable table = transitions();
  for (int later = 0; later < table.count; ++later) {
    for (int mode = 0; mode < kModeCount; ++mode) {
      if (!table.rows[later].from.has(static_cast<Mode>(mode))) continue;
      for (int earlier = 0; earlier < later; ++earlier) {
        const Transition& row = table.rows[earlier];
        const bool hides = row.event == table.rows[later].event && row.from.has(static_cast<Mode>(mode)) &&
                           &row.guards == &guards::kAlways;
        EXPECT_FALSE(hides) << "row " << later + 1 << " is never reached in mode "
                            << to_string(static_cast<Mode>(mode)) << ": row " << earlier + 1;
      }
    }
  }
}

// Failsafes that can trigger in one step of a flight, the most urgent first.
struct Urgency {
  Reason reason;
  std::function<void(Placed&)> change;
};
const std::vector<Urgency>& failsafes() {
  static const std::vector<Urgency> kFailsafes = {
      {Reason::kImuUnusable, [](Placed& f) { f.inputs_.imu_unusable_s = 0.2; }},
      {Reason::kImuGap, [](Placed& f) { f.inputs_.imu_gap_s = 0.4; }},
      {Reason::kTippedOver,
       [](Placed& f) { f.estimate_.q_ned_from_frd = Eigen::AngleAxisd(1.5, Vector3d::UnitY()); }},
      {Reason::kVehicleFault, [](Placed& f) { f.inputs_.vehicle_fault_s = 1.0; }},
      {Reason::kTakeoffInconsistent, [](Placed& f) { f.inputs_.takeoff_inconsistent = true; }},
      {Reason::kImpact, [](Placed& f) { f.inputs_.specific_force_frd.z() = -120.0; }},
      {Reason::kPoseJumped, [](Placed& f) { f.inputs_.pose_jumped = true; }},
      {Reason::kNoPose, [](Placed& f) { f.inputs_.pose_age_s = 0.6; }},
      {Reason::kBatteryCritical, [](Placed& f) { f.inputs_.supply_voltage_v = 3.0; }},
      {Reason::kOutsideFence, [](Placed& f) { f.estimate_.position_ned.y() = -3.3; }},
      {Reason::kBatteryLow,
       [](Placed& f) { f.inputs_.supply_voltage_v = std::min(f.inputs_.supply_voltage_v, 3.2); }},
      {Reason::kBatterySilent, [](Placed& f) { f.inputs_.battery_age_s = 2.1; }},
      {Reason::kGroundLinkLost, [](Placed& f) { f.lose_ground_link(); }},
  };
  return kFailsafes;
}

TEST(Priorities, MostUrgentFailsafeIsTaken) {
  const unsigned sets = 1U << failsafes().size();
  for (const char letter : {'T', 'H', 'M', 'J', 'S', 'P'}) {
    const auto place =
        std::find_if(places().begin(), places().end(), [&](const Place& p) { return p.letter == letter; });
    Placed flight(kLand);
    ASSERT_TRUE(place->reach(flight));
    const Placed::Snapshot in_flight = flight.snapshot();
    for (unsigned set = 1; set < sets; ++set) {
      flight.restore(in_flight);
      std::optional<Reason> most_urgent;
      for (std::size_t i = 0; i < failsafes().size(); ++i) {
        if ((set >> i & 1U) == 0) continue;
        failsafes()[i].change(flight);
        if (!most_urgent) most_urgent = failsafes()[i].reason;
      }
      flight.step();
      ASSERT_EQ(flight.supervisor_.reason(), *most_urgent)
          << place->name << ", set " << set << ": " << to_string(flight.supervisor_.reason());
    }
  }
}

// A condition at its limit and just beyond it.
struct Limit {
  const char* name;
  char place;
  Reason reason;
  double limit;
  double beyond;
  std::function<void(Placed&, double)> set;
};
void PrintTo(const Limit& limit, std::ostream* out) { *out << limit.name; }

class FailsafeLimits : public testing::TestWithParam<Limit> {};

TEST_P(FailsafeLimits, TriggerBeyondTheLimitOnly) {
  const Limit& limit = GetParam();
  const auto place =
      std::find_if(places().begin(), places().end(), [&](const Place& p) { return p.letter == limit.place; });
  for (const bool beyond : {false, true}) {
    Placed flight(kLand);
    ASSERT_TRUE(place->reach(flight));
    limit.set(flight, beyond ? limit.beyond : limit.limit);
    flight.step();
    EXPECT_EQ(flight.supervisor_.reason() == limit.reason, beyond)
        << to_string(flight.supervisor_.reason()) << " at " << (beyond ? limit.beyond : limit.limit);
  }
}

const FailsafeSettings kThresholds;
const Limit kLimits[] = {
    {"imu_timeout_s", 'H', Reason::kImuUnusable, kThresholds.imu_timeout_s - 1e-9, kThresholds.imu_timeout_s,
     [](Placed& f, double v) { f.inputs_.imu_unusable_s = v; }},
    {"imu_gap_s", 'H', Reason::kImuGap, kThresholds.imu_gap_s, kThresholds.imu_gap_s + 1e-9,
     [](Placed& f, double v) { f.inputs_.imu_gap_s = v; }},
    {"tip_over_tilt_rad", 'H', Reason::kTippedOver, kThresholds.tip_over_tilt_rad - 1e-6,
     kThresholds.tip_over_tilt_rad + 1e-6,
     [](Placed& f, double v) { f.estimate_.q_ned_from_frd = Eigen::AngleAxisd(v, Vector3d(0.6, 0.8, 0.0)); }},
    {"impact_m_s2", 'H', Reason::kImpact, kThresholds.impact_acceleration,
     kThresholds.impact_acceleration + 1e-9,
     [](Placed& f, double v) { f.inputs_.specific_force_frd.z() = -v; }},
    {"mocap_timeout_s", 'H', Reason::kNoPose, kThresholds.mocap_timeout_s, kThresholds.mocap_timeout_s + 1e-9,
     [](Placed& f, double v) { f.inputs_.pose_age_s = v; }},
    {"low_battery_voltage", 'H', Reason::kBatteryLow, kThresholds.low_battery_voltage,
     kThresholds.low_battery_voltage - 1e-9, [](Placed& f, double v) { f.inputs_.supply_voltage_v = v; }},
    {"critical_battery_voltage", 'L', Reason::kBatteryCritical, kThresholds.critical_battery_voltage,
     kThresholds.critical_battery_voltage - 1e-9,
     [](Placed& f, double v) { f.inputs_.supply_voltage_v = v; }},
    {"battery_timeout_s", 'H', Reason::kBatterySilent, kThresholds.battery_timeout_s,
     kThresholds.battery_timeout_s + 1e-9, [](Placed& f, double v) { f.inputs_.battery_age_s = v; }},
    {"fence_margin_m", 'H', Reason::kOutsideFence, 3.0 + kThresholds.fence_margin_m - 1e-9,
     3.0 + kThresholds.fence_margin_m + 1e-9, [](Placed& f, double v) { f.estimate_.position_ned.x() = v; }},
    {"fence_margin_m upward", 'H', Reason::kOutsideFence, -2.5 - kThresholds.fence_margin_m + 1e-9,
     -2.5 - kThresholds.fence_margin_m - 1e-9, [](Placed& f, double v) { f.estimate_.position_ned.z() = v; }},
};
INSTANTIATE_TEST_SUITE_P(Settings, FailsafeLimits, testing::ValuesIn(kLimits));

}  // namespace swiftlet::control::transitions_test
