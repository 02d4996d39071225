#include "swiftlet/analysis/identify/identify_options.hpp"

#include <memory>

#include "swiftlet/analysis/identify/identify_actions.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/configuration.hpp"

namespace swiftlet::analysis {
namespace {

io::Command add_flight_command(runtime::CommandLine identify) {
  const auto options = std::make_shared<IdentifyFlightOptions>();
  const runtime::CommandLine app =
      identify.add_subcommand("flight", "Identify a vehicle from logs of its flights");
  app.add_option("logs", options->logs,
                 "flight records, MCAP files of `swiftlet record`, or CSV files, "
                 "plain or gzip, or logs of PX4, .ulg, for its thrust scale; all of one vehicle")
      .required()
      .type_name("LOG...");
  app.add_option("--vehicle-name", options->vehicle, "which vehicle of an MCAP file that has several");
  app.add_option("--base", options->base,
                 "base vehicle for parameters that are not identified: a vehicle file, or the name of one in "
                 "the configuration; default: the one in the record")
      .type_name(io::kinds::kVehicle.value);
  app.add_choice("--known", options->fit.known,
                 {{"mass", identification::Known::kMass}, {"thrust", identification::Known::kThrust}},
                 "value of the base vehicle that is correct; a flight determines only thrust over mass")
      .show_default("mass");
  app.add_choice("--axes", options->axes, {{"frd", BodyAxes::kFrd}, {"flu", BodyAxes::kFlu}},
                 "body axes of the IMU if the column names do not give them: frd or flu");
  app.add_option("--from", options->fit.bounds.from_s,
                 "start of the flight, s by the clock of the log; default: detected")
      .finite();
  app.add_option("--until", options->fit.bounds.until_s,
                 "end of the flight, s by the clock of the log; default: detected")
      .finite();
  app.add_option("--out", options->out, "vehicle file to write").type_name("FILE");
  app.add_option("--report", options->report, "HTML report to write, with estimates and predictions")
      .type_name("FILE");
  app.add_option("--name", options->name, "name of the identified vehicle; default: stem of --out");
  app.add_flag("--json", options->json, "print one JSON object instead of the table");
  app.footer(
      "Columns of a log, each headed `name [unit]`: time; specific_force_x, body_rate_x, likewise y and z; "
      "throttle1, or "
      "pulse_width1, for each\nmotor in the order of the vehicle's rotors. Optional: supply_voltage; "
      "pose_time with position_x_ned and "
      "orientation_w_ned_from_frd and so on;\nrunning; rotor_speed1 and so on. A log without poses or "
      "voltage determines fewer parameters (docs/identification.md).\n\n"
      "example: swiftlet sim fly identification --record first && swiftlet identify flight first --out "
      "mine.yaml\n"
      "         swiftlet identify flight tests/data/crazyflie_flight.csv.gz --base crazyflie2");
  return {app, [options] { return identify_flight(*options); }};
}

io::Command add_simulate_command(runtime::CommandLine identify) {
  const auto options = std::make_shared<IdentifySimulateOptions>();
  const runtime::CommandLine app = identify.add_subcommand(
      "simulate", "Simulate bench data of a known vehicle, to test the identification");
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in the configuration")
      .type_name(io::kinds::kVehicle.value)
      .show_default();
  app.add_option("--noise", options->noise.share,
                 "standard deviation of each reading, as a fraction of the largest of its column")
      .finite()
      .range(0.0, 0.5)
      .show_default();
  app.add_option("--outliers", options->noise.outliers,
                 "fraction of the rows in which a reading is an outlier")
      .finite()
      .range(0.0, 0.4)
      .show_default();
  app.add_option("--seed", options->seed, "random seed of the noise").whole().show_default();
  app.add_option("--out", options->out, "folder to write the bench data to").required().type_name("DIR");
  app.footer(
      "example: swiftlet identify simulate --vehicle kaylion --noise 0.01 --outliers 0.02 --out bench");
  return {app, [options] { return identify_simulate(*options); }};
}

}  // namespace

io::Command add_identify_command(runtime::CommandLine root) {
  const runtime::CommandLine app = root.add_subcommand("identify", io::purpose_of("identify"));
  const auto options = std::make_shared<IdentifyBenchOptions>();
  const io::Command simulate = add_simulate_command(app);
  const io::Command flight = add_flight_command(app);
  app.require_subcommand(0, 1);
  app.add_option("bench", options->bench, "folder of bench data").type_name("BENCH_DIR");
  app.add_option("--out", options->out, "vehicle file to write").type_name("FILE");
  app.add_option("--report", options->report, "HTML report to write, with figures, fits and intervals")
      .type_name("FILE");
  app.add_option("--base", options->base,
                 "base vehicle for parameters that are not measured: a vehicle file, or the name of one in "
                 "the configuration; default: base_vehicle of bench.yaml, else kaylion")
      .type_name(io::kinds::kVehicle.value);
  app.add_option("--name", options->name, "name of the identified vehicle; default: stem of --out");
  app.add_flag("--json", options->json, "print one JSON object instead of the table");
  app.footer(
      "BENCH_DIR contains one CSV for each experiment, at least one, with column headers `name [unit]`:\n"
      "  esc.csv              supply_voltage, throttle or pulse_width, motor_voltage\n"
      "  motor_step.csv       time, speed, motor_voltage if recorded\n"
      "  steady_motor.csv     motor_voltage, speed\n"
      "  thrust_torque.csv    speed, thrust and/or torque\n"
      "  throttle_thrust.csv  supply_voltage, throttle or pulse_width, thrust of one rotor\n"
      "  inertia_roll.csv, inertia_pitch.csv, inertia_yaw.csv\n"
      "                       length, separation, period (bifilar), or arm, period (pendulum)\n"
      "  mass.csv             mass\n"
      "and optionally bench.yaml: base_vehicle, name, propeller, instruments (docs/identification.md).\n\n"
      "example: swiftlet identify bench --out mine.yaml --report report.html\n"
      "         swiftlet identify simulate --vehicle kaylion --noise 0.01 --out bench");
  return {app, [options, simulate, flight] {
            if (simulate.app.parsed()) return simulate.run();
            if (flight.app.parsed()) return flight.run();
            if (options->bench.empty()) throw io::InputError("identify: BENCH_DIR is required");
            if (options->out.empty()) throw io::InputError("identify: --out is required");
            return identify_bench(*options);
          }};
}

}  // namespace swiftlet::analysis
