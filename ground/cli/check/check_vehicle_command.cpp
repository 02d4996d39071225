#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "swiftlet/ground/cli/check/check_report.hpp"
#include "swiftlet/ground/cli/check/examine_standing.hpp"
#include "swiftlet/ground/cli/check/operator_dialog.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/cli/check/steps.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/hover_test.hpp"
#include "swiftlet/ground/client/network_options.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/vehicle_check/commands.hpp"
#include "swiftlet/ground/vehicle_check/hand_motion.hpp"
#include "swiftlet/ground/vehicle_check/streams.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kRecordedStep{50};

struct CheckVehicleOptions {
  dds::NodeSettings network;
  std::string vehicle = "kaylion";
  double time_s = 2.0;
  double timeout_s = 5.0;
  bool hand = false;
  bool props_off = false;
  bool tethered = false;
  bool hover = false;
  bool yes = false;
  bool json = false;
};

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1e3));
}

// Throws InputError unless a person confirms what the rotors may do.
void confirm(const CheckVehicleOptions& options, const OperatorDialog& dialog) {
  if ((!options.props_off && !options.tethered && !options.hover) || options.yes) return;
  const std::string option = options.props_off ? "--props-off" : options.hover ? "--hover" : "--tethered";
  const std::string state = options.props_off ? "all propellers are off"
                            : options.hover   ? "the vehicle may take off and nobody is near"
                                              : "the vehicle is tethered and nobody is near";
  if (!dialog.has_terminal())
    throw io::InputError("check vehicle: " + option + ": confirm with --yes that " + state +
                         "; the rotors will turn");
  const std::string typed = dialog.ask_line("The rotors will turn. Type yes if " + state + ":", [] {});
  if (typed != "yes") throw io::InputError("check vehicle: not confirmed, nothing was sent");
}

StandingExamination examine_at_rest(SampleRecorder& recorder, const CheckVehicleOptions& options,
                                    const plant::Vehicle& vehicle, const OperatorDialog& dialog) {
  dialog.say("the vehicle must stand level and still, with its rotors off");
  StandingRequest request;
  request.vehicle = &vehicle;
  request.mocap_required = options.hand;
  request.time = milliseconds(options.time_s);
  request.timeout = milliseconds(options.timeout_s);
  request.cancelled = [&] { return dialog.interrupted(); };
  StandingExamination examination = examine_standing(recorder, request);
  dialog.require_going_on();
  return examination;
}

CheckResults check_in_hand(SampleRecorder& recorder, const VehicleRecording& rest,
                           const OperatorDialog& dialog) {
  recorder.restart(vehicle_rate(rest));
  const std::vector<HandSegment> segments = guide_hand(recorder, dialog);
  return check_hand_motion(recorder.recording(), segments, rest);
}

void require_actuators(const VehicleDescription& vehicle) {
  if (vehicle.levels.has(plant::ControlLevel::kActuators)) return;
  throw std::runtime_error(fmt::format("the check commands throttles, and the vehicle accepts only level {}",
                                       vehicle.levels.names().data()));
}

CheckResults command_and_check(SampleRecorder& recorder, const VehicleRecording& rest,
                               const CheckVehicleOptions& options, const plant::Vehicle& vehicle,
                               const OperatorDialog& dialog) {
  if (const auto vehicle_info = recorder.recording().description) require_actuators(*vehicle_info);
  recorder.restart(vehicle_rate(rest));
  recorder.record(kRecordedStep, [] { return false; });
  if (options.tethered) {
    const CommandPhases phases = command_on_tether(recorder, options.network, vehicle, dialog);
    return check_rotor_thrusts(recorder.recording(), phases, vehicle);
  }
  const CommandPhases phases = command_without_propellers(recorder, options.network, vehicle, dialog);
  const VehicleRecording recording = recorder.recording();
  CheckResults results = check_commands(recording, phases);
  append(results, check_rotor_spins(recording, phases, vehicle));
  return results;
}

CheckResults check_by_commands(SampleRecorder& recorder, const VehicleRecording& rest,
                               const CheckVehicleOptions& options, const plant::Vehicle& vehicle,
                               const OperatorDialog& dialog) {
  try {
    return command_and_check(recorder, rest, options, vehicle, dialog);
  } catch (const std::runtime_error& refusal) {
    return {missing("commands.steps", refusal.what())};
  }
}

// Why the vehicle can be neither moved nor commanded; "" if it can. These checks need the stamps and arrivals that are
// checked first.
std::string fault_of_imu(const CheckResults& results) {
  const bool sound =
      passes(results, "imu.received") && passes(results, "imu.clock") && passes(results, "imu.stamps");
  return sound ? "" : "imu does not arrive with stamps that rise with the clock";
}

// Why the rotors must not turn; "" if they may.
std::string fault_of_rotors(const CheckResults& results, const CheckVehicleOptions& options) {
  // The throttle of half the hover thrust of one vehicle may lift another.
  const auto fails = [&](const char* name) { return has_verdict(results, name, Verdict::kFail); };
  const bool is_another =
      fails("vehicle_info.rotors") || fails("vehicle_info.mass") || fails("battery.voltage");
  if (options.tethered && is_another)
    return "the vehicle file, which tells the throttle, is of another vehicle or battery: choose it with "
           "--vehicle";
  return fault_of_imu(results);
}

// Why a hand must not take the vehicle; "" if it may.
std::string fault_of_hand(const CheckResults& results) {
  if (has_verdict(results, "commands.stop", Verdict::kFail)) return "the rotors did not stop";
  return fault_of_imu(results);
}

// Only a vehicle that is sound at rest takes off.
CheckResult check_hover(const CheckVehicleOptions& options, const CheckResults& at_rest,
                        const OperatorDialog& dialog) {
  const std::string name = "hover.test";
  if (any_failed(at_rest)) return skipped(name, "a check above fails");
  dialog.say("the vehicle takes off to 0.15 m, hovers for 2 s and lands");
  const std::string defect = fly_hover_test(options.network, [&] { return dialog.interrupted(); });
  const Verdict verdict = defect.empty() ? Verdict::kPass : Verdict::kFail;
  return {name, verdict, {0.15, "m", "0.15 m for 2 s"}, "nothing is wrong", defect};
}

CheckResults examine(const CheckVehicleOptions& options, const plant::Vehicle& vehicle,
                     const OperatorDialog& dialog) {
  SampleRecorder recorder(options.network);
  StandingExamination standing = examine_at_rest(recorder, options, vehicle, dialog);
  CheckResults results = std::move(standing.results);
  // First the rotors, while the vehicle stands: they must not start in the hand.
  if (options.props_off || options.tethered) {
    const std::string fault = fault_of_rotors(results, options);
    append(results, fault.empty() ? check_by_commands(recorder, standing.recording, options, vehicle, dialog)
                                  : CheckResults{skipped("commands.steps", fault)});
  }
  if (options.hover) results.push_back(check_hover(options, results, dialog));
  if (options.hand) {
    const std::string fault = fault_of_hand(results);
    append(results, fault.empty() ? check_in_hand(recorder, standing.recording, dialog)
                                  : CheckResults{skipped("hand.steps", fault)});
  }
  return results;
}

int check(const CheckVehicleOptions& options) {
  const plant::Vehicle vehicle =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  const Interrupts interrupts;
  const OperatorDialog dialog([&] { return interrupts.count() > 0; });
  CheckResults results;
  try {
    confirm(options, dialog);
    results = examine(options, vehicle, dialog);
  } catch (const Interrupted&) {
    throw std::runtime_error("check vehicle: interrupted");
  }
  if (options.json) {
    print_json(options.network.vehicle, options.network.domain, results);
  } else {
    print_table(stdout, options.network.vehicle, results);
  }
  return any_failed(results) ? io::kFailed : io::kDone;
}

}  // namespace

io::Command add_check_vehicle_command(runtime::CommandLine check_line) {
  const auto options = std::make_shared<CheckVehicleOptions>();
  const runtime::CommandLine app = check_line.add_subcommand(
      "vehicle", "Test a connected vehicle without flying: streams, stamps, axes, units, commands, rotors");
  add_network_options(app, options->network);
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("--time", options->time_s, "time for which the standing vehicle is recorded, s")
      .range(1.0, 600.0)
      .show_default();
  app.add_option("--timeout", options->timeout_s, "longest wait for the first imu sample, s")
      .range(0.1, 600.0)
      .show_default();
  const runtime::Option hand = app.add_flag(
      "--hand", options->hand, "guide motions of the vehicle in a hand, and compare IMU and motion capture");
  runtime::Option props_off = app.add_flag("--props-off", options->props_off,
                                           "turn the rotors, without propellers: order, spin, time-out, "
                                           "terms, rotors off. No controller may be alive");
  runtime::Option tethered =
      app.add_flag("--tethered", options->tethered,
                   "raise each rotor, with propellers, of a vehicle on a tether that lets it turn but not "
                   "leave: order and spin by the turn of the vehicle. No controller may be alive");
  tethered.excludes(props_off);
  tethered.excludes(hand);
  runtime::Option hover = app.add_flag(
      "--hover", options->hover,
      "let the controller fly a hover test of 2 s at 0.15 m under tight limits: rotors, gyro and "
      "motion capture that do not fit each other are named, and the rotors turned off");
  for (const char* const other : {"--hand", "--props-off", "--tethered"}) hover.excludes(app.option(other));
  app.add_flag(
      "--yes", options->yes,
      "confirm that the propellers are off, the vehicle tethered, or that it may take off; do not ask");
  app.add_flag("--json", options->json, "print the results as JSON");
  app.footer(
      "The vehicle must stand level and still. Exit code 1 if a check fails.\nThe rotors are turned off at "
      "the end, also "
      "after Ctrl-C.\nexample: swiftlet check vehicle --json | jq '.checks[] | select(.verdict == "
      "\"fail\")'\nexample: "
      "swiftlet check vehicle --hand --props-off");
  return {app, [options] { return check(*options); }};
}

}  // namespace swiftlet::ground
