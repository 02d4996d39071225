#include "swiftlet/ground/vehicle_check/commands.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/ground/vehicle_check/expect_results.hpp"
#include "tests/unit/ground/vehicle_check/recorded_vehicle.hpp"

namespace swiftlet::tests::commands_test {

using ground::CheckResults;
using ground::CommandPhase;
using ground::CommandStage;

CheckResults check(const RecordedCommands& record) {
  CheckResults results = ground::check_commands(record.recording, record.phases);
  ground::append(results, ground::check_rotor_spins(record.recording, record.phases, kaylion()));
  return results;
}

// What a person sees of a vehicle with these rotors, all spinning as in the vehicle file.
void look_at(RecordedCommands& record, const std::vector<int>& rotor_of) {
  const plant::Vehicle vehicle = kaylion();
  for (CommandPhase& phase : record.phases) {
    if (phase.stage != CommandStage::kSpin) continue;
    phase.seen_rotor = rotor_of[static_cast<std::size_t>(phase.rotor - 1)];
    phase.seen_spin = vehicle.rotors[static_cast<std::size_t>(phase.rotor - 1)].spin;
  }
}

const std::vector<std::string> kSpins = {"rotor_1.spin", "rotor_2.spin", "rotor_3.spin", "rotor_4.spin"};

TEST(Commands, AVehicleThatObeysPasses) {
  RecordedCommands record = record_commands({});
  expect_sound(check(record), kSpins);  // nobody looked
  look_at(record, {1, 2, 3, 4});
  expect_sound(check(record));
}

TEST(Commands, EachDefectIsCaughtAndNamed) {
  CommandDefects defects;
  defects.ignores_timeout = true;
  expect_names(check(record_commands(defects)), "commands.timeout", "ignored time-out");
  defects = {};
  defects.obeys_lower_terms = true;
  expect_names(check(record_commands(defects)), "commands.lower_term", "obeys commands of a lower term");
  defects = {};
  defects.turns_while_off = true;
  expect_names(check(record_commands(defects)), "commands.off", "rotors turn while off");
  expect_names(check(record_commands(defects)), "commands.stop", "rotors turn while off");
  defects = {};
  defects.is_deaf = true;
  expect_names(check(record_commands(defects)), "commands.obeyed", "commands do not reach the vehicle");
  expect_names(check(record_commands(defects)), "commands.idle", "the rotors do not start");
  defects = {};
  defects.idles_off = true;
  expect_names(check(record_commands(defects)), "commands.idle", "at throttle 0 turns them slowly");
}

TEST(Commands, WithoutReportsTheyAreSkippedWithTheReason) {
  CommandDefects defects;
  defects.reports_nothing = true;
  RecordedCommands record = record_commands(defects);
  record.recording.rotor_speeds.samples.clear();
  for (const ground::CheckResult& result : check(record)) {
    EXPECT_EQ(result.verdict, ground::Verdict::kSkipped) << result.name;
    EXPECT_FALSE(result.finding.empty()) << result.name;
  }
}

TEST(Commands, ReportsOfVehicleInfoTellWhetherRotorsTurn) {
  RecordedCommands record = record_commands({});
  const auto silence = ground::phase_of(record.phases, CommandStage::kSilence)->begin_ns;
  const auto idle = ground::phase_of(record.phases, CommandStage::kIdle)->begin_ns;
  const auto stopped = ground::phase_of(record.phases, CommandStage::kStopped)->begin_ns;
  record.recording.rotor_speeds.samples.clear();
  record.recording.rotors_running = {{false, record.recording.begin_ns},
                                     {true, idle + 5'000'000},
                                     {false, silence + 500'000'000},
                                     {true, silence + 1'900'000'000},
                                     {false, stopped + 5'000'000}};
  expect_sound(ground::check_commands(record.recording, record.phases));
  record.recording.rotors_running.resize(2);
  expect_names(ground::check_commands(record.recording, record.phases), "commands.timeout",
               "ignored time-out");
}

// Control waits with a take-off for the report of a vehicle that closes its inner loops itself.
TEST(Commands, AVehicleOfLevelsReportsThatItsRotorsRun) {
  RecordedCommands record = record_commands({});
  record.recording.description->levels.add(plant::ControlLevel::kRates);
  expect_names(ground::check_commands(record.recording, record.phases), "commands.rotors_running",
               "does not become true");
  const auto idle = ground::phase_of(record.phases, CommandStage::kIdle)->begin_ns;
  const auto stopped = ground::phase_of(record.phases, CommandStage::kStopped)->begin_ns;
  record.recording.rotors_running = {{false, record.recording.begin_ns}, {true, idle + 5'000'000}};
  expect_names(ground::check_commands(record.recording, record.phases), "commands.rotors_running",
               "stays true after ROTORS_OFF");
  record.recording.rotors_running.push_back({false, stopped + 5'000'000});
  expect_sound(ground::check_commands(record.recording, record.phases));
}

TEST(Commands, MissingStepsFail) {
  RecordedCommands record = record_commands({});
  record.phases.resize(3);
  expect_names(check(record), "commands.steps", "missing");
  expect_names(check(record), "rotors.steps", "missing");
}

TEST(Rotors, ExchangedOnesAreNamedBySpeedsAndByAPerson) {
  CommandDefects defects;
  defects.rotor_of = {1, 3, 2, 4};
  RecordedCommands record = record_commands(defects);
  expect_names(
      check(record), "rotor_2.order",
      "two rotors exchanged: rotor 2 (front left) and rotor 3 (rear left) answer each other's commands");
  record.recording.rotor_speeds.samples.clear();
  look_at(record, {1, 3, 2, 4});
  expect_names(check(record), "rotor_3.order", "two rotors exchanged");
}

TEST(Rotors, AnotherOrderIsNamed) {
  CommandDefects defects;
  defects.rotor_of = {2, 3, 4, 1};
  expect_names(check(record_commands(defects)), "rotor_1.order",
               "wrong order: the command of rotor 1 (front right) reaches rotor 2 (front left)");
}

TEST(Rotors, SpeedsNumberedOtherwiseAreNamed) {
  CommandDefects defects;
  defects.rotor_of = {2, 1, 3, 4};
  RecordedCommands record = record_commands(defects);
  look_at(record, {1, 2, 3, 4});
  expect_names(check(record), "rotor_1.speeds", "rotor_speeds are numbered otherwise");
}

TEST(Rotors, AWrongSpinThatAPersonSawIsNamed) {
  RecordedCommands record = record_commands({});
  look_at(record, {1, 2, 3, 4});
  for (CommandPhase& phase : record.phases) {
    if (phase.rotor == 2) phase.seen_spin = plant::Spin::kCounterClockwise;
  }
  expect_names(check(record), "rotor_2.spin",
               "wrong spin: rotor 2 (front left) turns counter-clockwise seen from above, the vehicle file "
               "says clockwise");
}

TEST(Tether, ThrustShowsOrderAndSpin) {
  const RecordedCommands record = record_thrusts(kaylion(), {1, 2, 3, 4});
  expect_sound(ground::check_rotor_thrusts(record.recording, record.phases, kaylion()));
}

TEST(Tether, ExchangedRotorsAreNamed) {
  const RecordedCommands record = record_thrusts(kaylion(), {1, 3, 2, 4});
  expect_names(ground::check_rotor_thrusts(record.recording, record.phases, kaylion()), "rotor_2.order",
               "two rotors exchanged");
}

TEST(Tether, AWrongSpinIsNamed) {
  plant::Vehicle built = kaylion();
  built.rotors[2].spin = plant::Spin::kClockwise;
  const RecordedCommands record = record_thrusts(built, {1, 2, 3, 4});
  expect_names(ground::check_rotor_thrusts(record.recording, record.phases, kaylion()), "rotor_3.spin",
               "wrong spin: rotor 3 (rear left)");
}

TEST(Tether, AVehicleThatCannotTurnFails) {
  RecordedCommands record = record_thrusts(kaylion(), {1, 2, 3, 4});
  for (auto& received : record.recording.imu.samples) received.sample.imu.body_rates_frd.setZero();
  expect_names(ground::check_rotor_thrusts(record.recording, record.phases, kaylion()), "rotor_1.order",
               "the vehicle does not turn");
}

}  // namespace swiftlet::tests::commands_test
