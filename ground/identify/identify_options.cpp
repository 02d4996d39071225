#include "swiftlet/ground/identify/identify_options.hpp"

#include <memory>

namespace swiftlet::ground {
namespace {

Command add_flight_command(runtime::CommandLine identify, const IdentifyActions& actions) {
  const auto options = std::make_shared<IdentifyFlightOptions>();
  const runtime::CommandLine app =
      identify.add_subcommand("flight", "Identify a vehicle from logs of its flights");
  app.add_option("logs", options->logs,
                 "records of `swiftlet fly --sensors`, or CSV files, gzip or not, of one vehicle")
      .required()
      .type_name("LOG...");
  app.add_option("--base", options->base,
                 "vehicle file, or the name of one in the configuration, for all that flights do not tell; "
                 "the record's "
                 "vehicle, else kaylion, unless given")
      .type_name("VEHICLE");
  app.add_choice("--known", options->fit.known,
                 {{"mass", identification::Known::kMass}, {"thrust", identification::Known::kThrust}},
                 "a flight tells thrust over mass alone: which of them the base vehicle has right")
      .show_default("mass");
  app.add_choice("--axes", options->axes, {{"frd", BodyAxes::kFrd}, {"flu", BodyAxes::kFlu}},
                 "body axes of the IMU, where the names of the columns do not say them: frd or flu");
  app.add_option("--from", options->fit.bounds.from_s,
                 "time by the log at which the flight begins, s; found unless given")
      .finite();
  app.add_option("--until", options->fit.bounds.until_s,
                 "time by the log at which it ends, s; found unless given")
      .finite();
  app.add_option("--out", options->out, "the vehicle file to write").type_name("FILE");
  app.add_option("--report", options->report, "a page with estimates and predictions; one HTML file")
      .type_name("FILE");
  app.add_option("--name", options->name, "name of the vehicle; that of --out unless given");
  app.add_flag("--json", options->json, "print one JSON object instead of the table");
  app.footer(
      "Columns of a log, each headed `name [unit]`: time; specific_force_x, body_rate_x, likewise y and z; "
      "throttle1, or "
      "pulse_width1, for each\nmotor in the order of the vehicle's rotors. If there: supply_voltage; "
      "pose_time with position_x_ned and "
      "orientation_w_ned_from_frd and so on;\nrunning; rotor_speed1 and so on. What a log without poses or "
      "voltage tells is less (docs/identification.md).\n\n"
      "example: swiftlet sim fly identification --sensors --record first && swiftlet identify flight first "
      "--out mine.yaml\n"
      "         swiftlet identify flight tests/data/crazyflie_flight.csv.gz --base crazyflie2");
  return {app, [options, run = actions.flight] { return run(*options); }};
}

Command add_simulate_command(runtime::CommandLine identify, const IdentifyActions& actions) {
  const auto options = std::make_shared<IdentifySimulateOptions>();
  const runtime::CommandLine app = identify.add_subcommand(
      "simulate", "Make bench data of a vehicle that is known, to try the identification on");
  app.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in the configuration")
      .show_default();
  app.add_option("--noise", options->noise.share,
                 "standard deviation of every reading, as a share of the largest of its column")
      .finite()
      .range(0.0, 0.5)
      .show_default();
  app.add_option("--outliers", options->noise.outliers, "share of the rows in which a reading is badly wrong")
      .finite()
      .range(0.0, 0.4)
      .show_default();
  app.add_option("--seed", options->seed, "of the noise").show_default();
  app.add_option("--out", options->out, "folder for the bench data").required().type_name("DIR");
  app.footer(
      "example: swiftlet identify simulate --vehicle kaylion --noise 0.01 --outliers 0.02 --out bench");
  return {app, [options, run = actions.simulate] { return run(*options); }};
}

}  // namespace

Command add_identify_options(runtime::CommandLine app, const IdentifyActions& actions) {
  const auto options = std::make_shared<IdentifyBenchOptions>();
  const Command simulate = add_simulate_command(app, actions);
  const Command flight = add_flight_command(app, actions);
  app.require_subcommand(0, 1);
  app.add_option("bench", options->bench, "folder of bench data").type_name("BENCH_DIR");
  app.add_option("--out", options->out, "the vehicle file to write").type_name("FILE");
  app.add_option("--report", options->report, "a page with figures, fits and intervals; one HTML file")
      .type_name("FILE");
  app.add_option("--base", options->base,
                 "vehicle file, or the name of one in the configuration, for all that was not measured; what "
                 "bench.yaml says, or kaylion, unless given")
      .type_name("VEHICLE");
  app.add_option("--name", options->name, "name of the vehicle; that of --out unless given");
  app.add_flag("--json", options->json, "print one JSON object instead of the table");
  app.footer(
      "BENCH_DIR holds one CSV an experiment, any of them, each column headed `name [unit]`:\n"
      "  esc.csv              supply_voltage, throttle or pulse_width, motor_voltage\n"
      "  motor_step.csv       time, speed, motor_voltage if recorded\n"
      "  steady_motor.csv     motor_voltage, speed\n"
      "  thrust_torque.csv    speed, thrust and/or torque\n"
      "  throttle_thrust.csv  supply_voltage, throttle or pulse_width, thrust of one rotor\n"
      "  inertia_roll.csv, inertia_pitch.csv, inertia_yaw.csv\n"
      "                       length, separation, period (two strings), or arm, period (swung)\n"
      "  mass.csv             mass\n"
      "and, if wanted, bench.yaml: base_vehicle, name, propeller, instruments (docs/identification.md).\n\n"
      "example: swiftlet identify bench --out mine.yaml --report report.html\n"
      "         swiftlet identify simulate --vehicle kaylion --noise 0.01 --out bench");
  return {app, [options, simulate, flight, run = actions.bench] {
            if (simulate.app.parsed()) return simulate.run();
            if (flight.app.parsed()) return flight.run();
            if (options->bench.empty()) throw InputError("identify: BENCH_DIR is required");
            if (options->out.empty()) throw InputError("identify: --out is required");
            return run(*options);
          }};
}

}  // namespace swiftlet::ground
