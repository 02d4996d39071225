#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/open_loop.hpp"

namespace swiftlet::ground {
namespace {

struct OpenLoopOptions {
  std::string vehicle;
  std::string pulses;
  std::string initial;
  std::string out;
  double supply_voltage_v = 0.0;
};

int run_open_loop(const OpenLoopOptions& options) {
  const plant::Vehicle vehicle =
      io::load_vehicle(io::configuration_file(io::kinds::kVehicle, options.vehicle));
  const int rotors = vehicle.rotor_count();
  const std::vector<simulation::PulseWidths> pulses =
      simulation::read_pulses(io::load_csv(options.pulses, simulation::pulse_columns(rotors), 2), vehicle);
  plant::VehicleState initial;
  if (!options.initial.empty())
    initial =
        simulation::read_state(io::load_csv(options.initial, simulation::state_columns(rotors)), rotors);

  const std::vector<simulation::MotionRow> rows =
      simulation::simulate_open_loop(vehicle, options.supply_voltage_v, initial, pulses);
  simulation::write_motion(options.out, rows, rotors);
  std::fprintf(stderr, "swiftlet: simulated %s for %.3f s at %g V, %zu rows in %s\n", vehicle.name.c_str(),
               static_cast<double>(pulses.back().time_ns - pulses.front().time_ns) * 1e-9,
               options.supply_voltage_v, rows.size(), options.out.c_str());
  return io::kDone;
}

}  // namespace

io::Command add_sim_open_loop_command(runtime::CommandLine sim) {
  const auto options = std::make_shared<OpenLoopOptions>();
  const runtime::CommandLine open_loop = sim.add_subcommand("open-loop", io::purpose_of("sim open-loop"));
  open_loop.footer(
      "--pwm has the columns t,pwm1,pwm2,...: seconds and microseconds, held until the next row; the time of "
      "the last row\n"
      "ends the run. --initial has one row px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r,om1,...: position and "
      "velocity in NED (m, m/s),\n"
      "quaternion NED from FRD, body rates and rotor speeds (rad/s). --out has column t, then the same, one "
      "row per "
      "ms.\nThere is no ground, drag or noise, and the supply is ideal.\n\n"
      "example: swiftlet sim open-loop --vehicle kaylion --pwm pulses.csv --supply 3.7 --out motion.csv");
  open_loop.add_option("--vehicle", options->vehicle, "vehicle file, or the name of one in config/vehicles")
      .type_name(io::kinds::kVehicle.value)
      .required();
  open_loop.add_option("--pwm", options->pulses, "pulse widths, CSV file").required();
  open_loop.add_option("--supply", options->supply_voltage_v, "supply voltage v_s of Eq. (9), V")
      .required()
      .finite()
      .range(0.1, 100.0);
  open_loop.add_option("--initial", options->initial,
                       "initial state, CSV file; default: at rest at the origin, rotors stopped");
  open_loop.add_option("--out", options->out, "simulated motion, CSV file").required();
  return {open_loop, [options] { return run_open_loop(*options); }};
}

}  // namespace swiftlet::ground
