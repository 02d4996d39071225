// Flights in this process: one, many, and of the vehicle alone.
#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "bindings.hpp"
#include "cancellation.hpp"

#include "swiftlet/ground/batch/batch.hpp"
#include "swiftlet/ground/batch/batch_report.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/ground/flight/recorded_flight.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/simulation/open_loop.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;
using MissionArgument = std::variant<std::string, io::MissionFile>;

struct PlannedFlight {
  ground::FlyOptions options;
  ground::FlightInputs given;

  ground::LaunchConfiguration plan() const {
    if (given.vehicle && options.dispersion == simulation::kUncertainty) refuse_uncertainty_of_model();
    if (given.any() && !options.record.empty())
      throw io::InputError(
          "a record holds the files of the flight: name the files of vehicle, control, simulation and "
          "mission");
    return ground::plan_flight(options, given);
  }
};

template <class Model>
void take(const std::variant<std::string, Model>& argument, std::string& name, std::optional<Model>& model) {
  if (const auto* text = std::get_if<std::string>(&argument)) {
    name = *text;
  } else {
    model = std::get<Model>(argument);
  }
}

PlannedFlight planned(const MissionArgument& mission, const VehicleArgument& vehicle,
                      const ControlArgument& control, const SimulationArgument& simulation,
                      const std::string& dispersion, std::uint64_t seed, const std::string& level,
                      const Eigen::Vector2d& start_ned) {
  PlannedFlight flight;
  ground::FlyOptions& options = flight.options;
  options.launch_mode = ground::LaunchMode::kInProcess;
  take(mission, options.mission, flight.given.mission);
  take(vehicle, options.vehicle, flight.given.vehicle);
  take(control, options.control, flight.given.control);
  take(simulation, options.simulation, flight.given.simulation);
  options.dispersion = dispersion;
  options.seed = seed;
  options.start_ned = start_ned;
  options.level = level_of(level);
  return flight;
}

// For a program without a terminal of its own: drops what would be said there.
class NoProgress final : public io::Progress {
 public:
  void update(int, const std::string&) override {}
  void say(const std::string&) override {}
};

struct Flight {
  analysis::FlightReport report;
  std::shared_ptr<record::Flight> flown;
};

// The rows as a structured array, of which each column is a view.
template <class Row>
py::dict columns_of(const std::vector<Row>& track) {
  const py::array_t<Row> rows(static_cast<py::ssize_t>(track.size()), track.data());
  py::dict columns;
  for (const auto name : rows.dtype().attr("names"))
    columns[name] = rows[py::reinterpret_borrow<py::str>(name)];
  columns["time_s"] = columns["stamp_ns"].attr("__mul__")(1e-9);
  return columns;
}

Flight simulate(const PlannedFlight& planned, bool replace, const std::string& record) {
  Flight flight;
  Cancellation cancelled;
  {
    const py::gil_scoped_release without_gil;
    ground::FlyOptions options = planned.options;
    options.record = record;
    options.replace = replace;
    const ground::LaunchConfiguration plan = PlannedFlight{options, planned.given}.plan();
    flight.flown = std::make_shared<record::Flight>();
    const auto is_cancelled = [&cancelled] { return cancelled(); };
    if (record.empty()) {
      simulation::ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
      flight.report = fly_in_process(loop, plan, plan.seed, *flight.flown, nullptr, is_cancelled);
      flight.report.record_dir.clear();
    } else {
      NoProgress progress;
      flight.report = fly_and_record(plan, options, *flight.flown, is_cancelled, progress);
    }
  }
  cancelled.raise_if_cancelled();
  return flight;
}

py::dict dict_of(const ground::Batch& batch, const std::vector<std::string>& parameters) {
  const auto rows = static_cast<py::ssize_t>(batch.runs.size());
  py::array_t<std::uint64_t> seed(rows);
  py::array_t<bool> completed(rows);
  py::array_t<double> rms(rows), peak(rows), duration(rows);
  py::array_t<double> margins(std::vector<py::ssize_t>{rows, 6});
  py::array_t<double> values(std::vector<py::ssize_t>{rows, static_cast<py::ssize_t>(parameters.size())});
  py::list reasons;
  for (py::ssize_t i = 0; i < rows; ++i) {
    const ground::BatchRun& run = batch.runs[static_cast<std::size_t>(i)];
    seed.mutable_at(i) = run.seed;
    completed.mutable_at(i) = run.completed;
    rms.mutable_at(i) = run.rms_3d_m;
    peak.mutable_at(i) = run.peak_3d_m;
    duration.mutable_at(i) = run.duration_s;
    const auto of_run = ground::as_array(run.margins_deg);
    for (std::size_t j = 0; j < of_run.size(); ++j)
      margins.mutable_at(i, static_cast<py::ssize_t>(j)) = of_run[j];
    for (std::size_t j = 0; j < run.values.size(); ++j)
      values.mutable_at(i, static_cast<py::ssize_t>(j)) = run.values[j];
    reasons.append(run.reason);
  }
  return py::dict("seed"_a = seed, "completed"_a = completed, "reason"_a = reasons, "rms_3d_m"_a = rms,
                  "peak_3d_m"_a = peak, "duration_s"_a = duration, "margins_deg"_a = margins,
                  "parameters"_a = parameters, "values"_a = values);
}

py::dict simulate_batch(const PlannedFlight& planned, std::size_t runs, std::size_t jobs) {
  if (runs == 0) refuse("runs is 0, must be at least 1");
  ground::Batch batch;
  std::vector<std::string> parameters;
  Cancellation cancelled;
  {
    const py::gil_scoped_release without_gil;
    const ground::LaunchConfiguration plan = planned.plan();
    for (const simulation::ParameterDistribution& one : plan.dispersion.distributions)
      parameters.push_back(one.what().name);
    const std::size_t threads = jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
    std::atomic<bool> ends{false};
    batch = ground::BatchRunner(plan, runs)
                .fly(
                    threads, [&ends] { return ends.load(); },
                    [&](const ground::BatchProgress&) {
                      cancelled.check();
                      ends = cancelled.is_cancelled();
                    });
  }
  cancelled.raise_if_cancelled();
  return dict_of(batch, parameters);
}

// The table of a file with these columns.
io::Table table_of(const std::string& name, std::vector<std::string> columns,
                   const std::vector<std::vector<double>>& rows) {
  io::Table table(name, std::move(columns));
  int number = 0;
  for (const std::vector<double>& row : rows) table.add_row(++number, row, {});
  return table;
}

py::dict open_loop(const plant::Vehicle& vehicle, const Array<double>& time_s, const Array<double>& pulse_us,
                   const std::optional<Array<double>>& initial, double supply_voltage_v) {
  const int rotors = vehicle.rotor_count();
  for (const plant::Violation& violation : plant::validate(vehicle))
    refuse("vehicle: " + violation.key + ": " + violation.message);
  if (time_s.ndim() != 1 || time_s.size() < 2) refuse("time_s must have shape (rows,) with at least 2 rows");
  if (pulse_us.ndim() != 2 || pulse_us.shape(0) != time_s.shape(0) || pulse_us.shape(1) != rotors)
    refuse("pulse_us must have shape (" + std::to_string(time_s.size()) + ", " + std::to_string(rotors) +
           "): a row for each of time_s, a column for each rotor");
  const auto state_size = static_cast<std::size_t>(13 + rotors);
  std::vector<double> state(state_size, 0.0);
  state[6] = 1.0;
  if (initial) {
    if (static_cast<std::size_t>(initial->size()) != state_size)
      refuse("initial must have shape (" + std::to_string(state_size) + ",)");
    std::copy_n(initial->data(), state_size, state.begin());
  }
  std::vector<std::vector<double>> pulses;
  for (py::ssize_t i = 0; i < time_s.size(); ++i) {
    pulses.push_back({time_s.at(i)});
    for (int rotor = 0; rotor < rotors; ++rotor) pulses.back().push_back(pulse_us.at(i, rotor));
  }
  std::vector<simulation::MotionRow> rows;
  {
    const py::gil_scoped_release without_gil;
    rows = simulation::simulate_open_loop(
        vehicle, supply_voltage_v,
        simulation::read_state(table_of("initial", simulation::state_columns(rotors), {state}), rotors),
        simulation::read_pulses(table_of("pulse_us", simulation::pulse_columns(rotors), pulses), vehicle));
  }
  const auto count = static_cast<py::ssize_t>(rows.size());
  py::array_t<double> time(count);
  py::array_t<double> position(std::vector<py::ssize_t>{count, 3}),
      velocity(std::vector<py::ssize_t>{count, 3}), attitude(std::vector<py::ssize_t>{count, 4}),
      rates(std::vector<py::ssize_t>{count, 3}), speeds(std::vector<py::ssize_t>{count, rotors});
  for (py::ssize_t i = 0; i < count; ++i) {
    const simulation::MotionRow& row = rows[static_cast<std::size_t>(i)];
    const Eigen::Quaterniond& q = row.state.q_ned_from_frd;
    time.mutable_at(i) = 1e-9 * static_cast<double>(row.time_ns);
    for (int axis = 0; axis < 3; ++axis) {
      position.mutable_at(i, axis) = row.state.position_ned[axis];
      velocity.mutable_at(i, axis) = row.state.velocity_ned[axis];
      rates.mutable_at(i, axis) = row.state.body_rates_frd[axis];
    }
    const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
    for (int k = 0; k < 4; ++k) attitude.mutable_at(i, k) = wxyz[k];
    for (int rotor = 0; rotor < rotors; ++rotor)
      speeds.mutable_at(i, rotor) = row.state.rotor_speeds[static_cast<std::size_t>(rotor)];
  }
  return py::dict("time_s"_a = time, "position_ned"_a = position, "velocity_ned"_a = velocity,
                  "q_ned_from_frd"_a = attitude, "body_rates_frd"_a = rates, "rotor_speeds"_a = speeds);
}

void add_flight(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(record::TruthRow, stamp_ns, position_ned, velocity_ned, q_ned_from_frd, body_rates_frd,
                       rotor_speeds, rotor_count, supply_voltage_v, on_ground);
  PYBIND11_NUMPY_DTYPE(record::ReferenceRow, stamp_ns, mode, position_ned, velocity_ned, acceleration_ned,
                       yaw_rad, q_ned_from_frd, thrust_n, moment_frd);
  PYBIND11_NUMPY_DTYPE(record::EstimateRow, stamp_ns, position_ned, velocity_ned);

  py::class_<Flight>(module, "Flight", "A simulated flight: its result, and what was recorded of it.")
      .def_property_readonly(
          "completed", [](const Flight& self) { return self.report.completed; },
          "True if the mission was completed within its tolerance.")
      .def_property_readonly(
          "reason", [](const Flight& self) { return self.report.reason; },
          "Why it was not completed; else empty.")
      .def_property_readonly(
          "rms_3d_m", [](const Flight& self) { return self.report.errors.rms_3d_m; },
          "Tracking error, m; NaN if the mission did not start.")
      .def_property_readonly(
          "peak_3d_m", [](const Flight& self) { return self.report.errors.peak_3d_m; },
          "Tracking error, m; NaN if the mission did not start.")
      .def_property_readonly(
          "duration_s", [](const Flight& self) { return self.report.duration_s; },
          "From the start of the mission to rotors off, s.")
      .def_property_readonly(
          "record", [](const Flight& self) { return self.report.record_dir; },
          "The folder of its record; empty without one.")
      .def(
          "report_json", [](const Flight& self) { return io::json_text(analysis::to_json(self.report), 2); },
          "What `swiftlet sim fly --json` prints.")
      .def(
          "truth", [](const Flight& self) { return columns_of(self.flown->truth); },
          "Ground truth at each IMU sample, by column, each with a row for each sample: stamp_ns, time_s; "
          "position_ned "
          "(n, 3) m, velocity_ned (n, 3) m/s, q_ned_from_frd (n, 4) w, x, y, z, body_rates_frd (n, 3) rad/s, "
          "rotor_speeds (n, 8) rad/s, of which the first rotor_count are used, supply_voltage_v, on_ground.")
      .def(
          "reference", [](const Flight& self) { return columns_of(self.flown->reference); },
          "The reference at 100 Hz: stamp_ns, time_s, mode; position_ned (n, 3) m, velocity_ned (n, 3) m/s, "
          "acceleration_ned (n, 3) m/s^2, yaw_rad, q_ned_from_frd (n, 4) of the attitude that is asked for, "
          "thrust_n, "
          "moment_frd (n, 3) N m.")
      .def(
          "estimate", [](const Flight& self) { return columns_of(self.flown->estimate); },
          "The estimate of the controller at 100 Hz: stamp_ns, time_s; position_ned (n, 3) m, velocity_ned "
          "(n, 3) m/s.");
}

void add_simulate(py::module_& module) {
  module.def(
      "simulate",
      [](const MissionArgument& mission, const VehicleArgument& vehicle, const ControlArgument& control,
         const SimulationArgument& simulation, const std::string& dispersion, std::uint64_t seed,
         const std::string& level, const Eigen::Vector2d& start_ned, const std::string& record,
         bool replace) {
        return simulate(planned(mission, vehicle, control, simulation, dispersion, seed, level, start_ned),
                        replace, record);
      },
      "mission"_a = "square", py::kw_only(), "vehicle"_a = "kaylion", "control"_a = "motor_lag",
      "simulation"_a = "default", "dispersion"_a = "", "seed"_a = 1, "level"_a = "actuators",
      "start_ned"_a = Eigen::Vector2d(0.0, 0.0), "record"_a = "", "replace"_a = false,
      "Flies a mission in this process, as `swiftlet sim fly` does, from arming to landing; the result is "
      "the same for the "
      "same seed. Each model is the name of a file, its path, or an object. dispersion: a file, or "
      "'uncertainty' of the "
      "vehicle file. start_ned: m north and east of the origin. record: a folder for the record of the "
      "flight, as "
      "`swiftlet sim fly` writes it; then models must be files. Throws InputError.");
  module.def(
      "simulate_batch",
      [](const MissionArgument& mission, std::size_t runs, const VehicleArgument& vehicle,
         const ControlArgument& control, const SimulationArgument& simulation, const std::string& dispersion,
         std::uint64_t seed, const std::string& level, std::size_t jobs) {
        return simulate_batch(
            planned(mission, vehicle, control, simulation, dispersion, seed, level, {0.0, 0.0}), runs, jobs);
      },
      "mission"_a = "square", "runs"_a = 20, py::kw_only(), "vehicle"_a = "kaylion",
      "control"_a = "motor_lag", "simulation"_a = "default", "dispersion"_a = "", "seed"_a = 1,
      "level"_a = "actuators", "jobs"_a = 0,
      "Flies a mission many times, as `swiftlet sim batch` does, on `jobs` threads; 0: one for each core. "
      "Run i has the "
      "seed seed + i; the result does not depend on jobs. Returns arrays with a row for each run: seed, "
      "completed, reason "
      "(a list), rms_3d_m and peak_3d_m (m), duration_s, margins_deg (runs, 6) of roll, pitch, yaw, x, y, z; "
      "and the drawn "
      "values (runs, parameters) of the names in parameters. Throws InputError.");
  module.def("simulate_open_loop", &open_loop, "vehicle"_a, "time_s"_a, "pulse_us"_a, py::kw_only(),
             "initial"_a = py::none(), "supply_voltage_v"_a = 3.7,
             "The motion of a vehicle under given pulse widths, Eq. (1)-(28), without ground, drag, wind or "
             "noise, with an ideal "
             "supply. time_s: (rows,), ascending. pulse_us: (rows, rotors), microseconds, each held until "
             "the next time. initial: "
             "(13 + rotors,): position (m, NED), velocity (m/s), quaternion w, x, y, z, body rates (rad/s), "
             "rotor speeds (rad/s); "
             "at rest in the origin if not given. Returns arrays with a row for each millisecond: time_s, "
             "position_ned, "
             "velocity_ned, q_ned_from_frd, body_rates_frd, rotor_speeds. Throws InputError.");
}

}  // namespace

void add_simulation(py::module_& module) {
  add_flight(module);
  add_simulate(module);
}

}  // namespace swiftlet::python
