// A flight in this process that advances in steps.
#include <memory>
#include <mutex>
#include <utility>

#include "bindings.hpp"
#include "cancellation.hpp"

#include "swiftlet/ground/client/vehicle_setpoints.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;

py::dict state_of(const plant::TruthSample& truth, double time_s) {
  const Eigen::Quaterniond& q = truth.q_ned_from_frd;
  return py::dict("time_s"_a = time_s, "position_ned"_a = truth.position_ned,
                  "velocity_ned"_a = truth.velocity_ned,
                  "q_ned_from_frd"_a = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()),
                  "body_rates_frd"_a = truth.body_rates_frd,
                  "rotor_speeds"_a = py::array_t<double>(truth.rotor_count, truth.rotor_speeds.data()),
                  "supply_voltage_v"_a = truth.supply_voltage_v, "on_ground"_a = truth.on_ground);
}

py::dict estimate_of(const control::Estimate& estimate) {
  const Eigen::Quaterniond& q = estimate.q_ned_from_frd;
  return py::dict("stamp_ns"_a = estimate.stamp_ns, "position_ned"_a = estimate.position_ned,
                  "velocity_ned"_a = estimate.velocity_ned,
                  "q_ned_from_frd"_a = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()));
}

struct Simulation {
  explicit Simulation(std::unique_ptr<simulation::ClosedLoop> made) : loop(std::move(made)) {}

  std::unique_ptr<simulation::ClosedLoop> loop;
  std::uint64_t setpoints = 0;
  mutable std::mutex in_use;  // another thread may call it while a step has released the GIL
};

// Objects of Python are made after the read: to make them may let another thread go on.
template <class Read>
auto read(const Simulation& simulation, const Read& of) {
  const InUse use(simulation.in_use);
  return of(*simulation.loop);
}

void step(Simulation& simulation, double duration_s) {
  constexpr double kLongest_s = 1e6;
  if (!(duration_s >= 0.0 && duration_s <= kLongest_s))
    refuse("duration_s is " + std::to_string(duration_s) + ", must be at least 0 and at most 1e6");
  const InUse use(simulation.in_use);
  simulation::ClosedLoop& loop = *simulation.loop;
  Cancellation cancelled;
  {
    const py::gil_scoped_release without_gil;
    const std::int64_t end_ns = loop.plant.stamp_ns() + static_cast<std::int64_t>(duration_s * 1e9 + 0.5);
    do {
      loop.step();
    } while (loop.plant.stamp_ns() < end_ns && !cancelled());
  }
  cancelled.raise_if_cancelled();
}

void request(Simulation& simulation, const control::Request& request) {
  const control::Outcome outcome =
      read(simulation, [&](simulation::ClosedLoop& loop) { return loop.controller.request(request); });
  if (!outcome.accepted) raise("RequestError", outcome.reason, "refused");
}

void request(Simulation& simulation, control::RequestKind kind) {
  control::Request of_kind;
  of_kind.kind = kind;
  request(simulation, of_kind);
}

void set(Simulation& simulation, const control::Setpoint& setpoint) {
  const control::Outcome outcome = read(simulation, [&](simulation::ClosedLoop& loop) {
    control::Setpoint stamped = setpoint;
    stamped.stamp_ns = loop.plant.stamp_ns();
    stamped.sequence = ++simulation.setpoints;
    return loop.controller.on_setpoint(stamped);
  });
  if (!outcome.accepted) raise("RequestError", outcome.reason, "refused");
}

std::unique_ptr<Simulation> make(const VehicleArgument& vehicle, const ControlArgument& control,
                                 const SimulationArgument& simulation, std::uint64_t seed) {
  const simulation::World world{vehicle_of(vehicle), simulation_of(simulation)};
  for (const plant::Violation& violation : simulation::validate(world))
    refuse(violation.key + ": " + violation.message);
  return std::make_unique<Simulation>(
      std::make_unique<simulation::ClosedLoop>(world.vehicle, world.simulation, control_of(control), seed));
}

void add_stepped_requests(py::class_<Simulation>& type) {
  using control::RequestKind;
  type.def(
          "arm", [](Simulation& self) { request(self, RequestKind::kArm); },
          "Throws RequestError with the reason if it is refused, as all requests do.")
      .def(
          "take_off",
          [](Simulation& self, double height_m, double speed_m_s) {
            control::Request takeoff;
            takeoff.kind = RequestKind::kTakeoff;
            takeoff.position_ned.z() = -height_m;
            takeoff.speed = speed_m_s;
            request(self, takeoff);
          },
          "height_m"_a = 1.0, "speed_m_s"_a = 0.5)
      .def(
          "go_to",
          [](Simulation& self, const Eigen::Vector3d& position_ned_m, std::optional<double> yaw_rad,
             double speed_m_s) {
            control::Request go_to;
            go_to.kind = RequestKind::kGoTo;
            go_to.position_ned = position_ned_m;
            go_to.yaw_free = !yaw_rad;
            go_to.yaw_rad = yaw_rad.value_or(0.0);
            go_to.speed = speed_m_s;
            request(self, go_to);
          },
          "position_ned_m"_a, "yaw_rad"_a = py::none(), "speed_m_s"_a = 0.5)
      .def("hold", [](Simulation& self) { request(self, RequestKind::kHold); })
      .def(
          "land",
          [](Simulation& self, double speed_m_s) {
            control::Request land;
            land.kind = RequestKind::kLand;
            land.speed = speed_m_s;
            request(self, land);
          },
          "speed_m_s"_a = 0.4)
      .def(
          "stop", [](Simulation& self) { request(self, RequestKind::kStop); }, "Stops the rotors at once.")
      .def(
          "send_velocity",
          [](Simulation& self, const Eigen::Vector3d& velocity_ned_m_s) {
            set(self, ground::to_setpoint(ground::VelocitySetpoint{velocity_ned_m_s}));
          },
          "velocity_ned_m_s"_a, "A setpoint of a stream, at least 2 Hz, from mode 'holding' on.")
      .def(
          "send_position",
          [](Simulation& self, const Eigen::Vector3d& position_ned_m) {
            set(self, ground::to_setpoint(ground::PositionSetpoint{position_ned_m}));
          },
          "position_ned_m"_a, "A setpoint of a stream, at least 2 Hz, from mode 'holding' on.");
}

}  // namespace

void add_stepped_simulation(py::module_& module) {
  using simulation::ClosedLoop;
  py::class_<Simulation> type(
      module, "Simulation",
      "A vehicle and its flight controller that advance when told: requests and setpoints in, states "
      "out. The same seed and calls give bit-identical results. Throws RuntimeError while another thread is "
      "in step().");
  type.def(py::init(&make), "vehicle"_a = "kaylion", "control"_a = "motor_lag", "simulation"_a = "default",
           "seed"_a = 1)
      .def("step", &step, "duration_s"_a = 0.0, "Advances by this time, at least to the next IMU sample, s.")
      .def_property_readonly(
          "time_s",
          [](const Simulation& self) {
            return read(self, [](const ClosedLoop& loop) { return loop.time_s(); });
          },
          "Simulated time, s.")
      .def_property_readonly(
          "mode",
          [](const Simulation& self) {
            return read(self, [](const ClosedLoop& loop) {
              return control::to_string(loop.controller.status().mode);
            });
          },
          "Flight mode: 'disarmed', 'holding' ...")
      .def(
          "state",
          [](const Simulation& self) {
            return state_of(read(self, [](const ClosedLoop& loop) { return loop.plant.truth(); }),
                            read(self, [](const ClosedLoop& loop) { return loop.time_s(); }));
          },
          "The ground truth: time_s; position_ned (3,) m, velocity_ned (3,) m/s, q_ned_from_frd (4,) w, x, "
          "y, z, "
          "body_rates_frd (3,) rad/s, rotor_speeds (rotors,) rad/s, supply_voltage_v, on_ground.")
      .def(
          "estimate",
          [](const Simulation& self) {
            return estimate_of(read(
                self, [](const ClosedLoop& loop) { return control::Estimate(loop.controller.estimate()); }));
          },
          "Of the controller: stamp_ns; position_ned (3,) m, velocity_ned (3,) m/s, q_ned_from_frd (4,).");
  add_stepped_requests(type);
}

}  // namespace swiftlet::python
