// Environments of reinforcement learning, many at once. swiftlet.gym gives them the interface of Gymnasium.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "bindings.hpp"

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "swiftlet/simulation/vector_environment.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;
using simulation::HoverTask;
using simulation::VectorEnvironment;

// Another thread may call it while a step has released the GIL.
struct HoverEnvironments : VectorEnvironment {
  using VectorEnvironment::VectorEnvironment;
  HoverEnvironments(const HoverEnvironments& other) : VectorEnvironment(other) {}
  std::mutex in_use;
};

simulation::Dispersion dispersion_of(const std::string& name, const VehicleArgument& vehicle,
                                     const simulation::World& world) {
  if (name.empty()) return {};
  if (name == simulation::kUncertainty) {
    const FileUncertainty of = uncertainty_of(vehicle);
    return simulation::dispersion_of(of.parameters, world.vehicle, of.file);
  }
  return simulation::load_dispersion_file(io::configuration_file(io::kinds::kDispersion, name), world);
}

std::unique_ptr<HoverEnvironments> make(std::size_t count, std::size_t threads,
                                        const VehicleArgument& vehicle, const SimulationArgument& simulation,
                                        const std::string& dispersion, const std::string& level,
                                        const HoverTask& task) {
  if (count == 0) refuse("count is 0, must be at least 1");
  HoverTask at_level = task;
  at_level.level = level_of(level);
  const simulation::World world{vehicle_of(vehicle), simulation_of(simulation)};
  const std::size_t used = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  return std::make_unique<HoverEnvironments>(world, at_level, dispersion_of(dispersion, vehicle, world),
                                             count, used);
}

template <class T = double>
py::array_t<T> rows_of(const VectorEnvironment& of, std::size_t columns) {
  return py::array_t<T>({of.count(), columns});
}

py::array_t<double> observations(const VectorEnvironment& of) {
  py::array_t<double> out = rows_of(of, of.observation_size());
  of.observe(out.mutable_data());
  return out;
}

using Flags = std::optional<Array<bool>>;

// Null if none are given.
const bool* flags_of(const Flags& flags, const VectorEnvironment& of) {
  if (flags && static_cast<std::size_t>(flags->size()) != of.count())
    refuse("chosen must have shape (" + std::to_string(of.count()) + ",)");
  return flags ? flags->data() : nullptr;
}

py::array_t<double> reset(HoverEnvironments& self, const std::optional<Array<std::uint64_t>>& seeds,
                          const Flags& chosen) {
  const InUse use(self.in_use);
  if (seeds && static_cast<std::size_t>(seeds->size()) != self.count())
    refuse("seeds must have shape (" + std::to_string(self.count()) + ",)");
  {
    const std::uint64_t* const data = seeds ? seeds->data() : nullptr;
    const bool* const flags = flags_of(chosen, self);
    const py::gil_scoped_release without_gil;
    self.reset(data, flags);
  }
  return observations(self);
}

py::tuple step(HoverEnvironments& self, const Array<double>& actions, const Flags& chosen) {
  const InUse use(self.in_use);
  const std::size_t size = self.bounds().low.size();
  if (actions.ndim() != 2 || static_cast<std::size_t>(actions.shape(0)) != self.count() ||
      static_cast<std::size_t>(actions.shape(1)) != size)
    refuse("actions must have shape (" + std::to_string(self.count()) + ", " + std::to_string(size) + ")");
  for (std::size_t i = 0; i < self.count() * size; ++i) {
    if (!std::isfinite(actions.data()[i]))
      refuse("the action of environment " + std::to_string(i / size) + " has a component that is not finite");
  }
  const auto rows = static_cast<py::ssize_t>(self.count());
  py::array_t<double> seen = rows_of(self, self.observation_size()),
                      last = rows_of(self, self.observation_size());
  py::array_t<double> rewards(rows);
  py::array_t<bool> terminated(rows), truncated(rows);
  VectorEnvironment::Step buffers;
  buffers.actions = actions.data();
  buffers.chosen = flags_of(chosen, self);
  buffers.observations = seen.mutable_data();
  buffers.final_observations = last.mutable_data();
  buffers.rewards = rewards.mutable_data();
  buffers.terminated = terminated.mutable_data();
  buffers.truncated = truncated.mutable_data();
  {
    const py::gil_scoped_release without_gil;
    self.step(buffers);
  }
  return py::make_tuple(seen, rewards, terminated, truncated, last);
}

}  // namespace

void add_environments(py::module_& module) {
  py::class_<HoverEnvironments>(
      module, "HoverEnvironments",
      "Vehicles that are to hover at a target, all stepped at once. See swiftlet.gym.")
      .def(py::init([](std::size_t count, std::size_t threads, const VehicleArgument& vehicle,
                       const SimulationArgument& simulation, const std::string& dispersion,
                       const std::string& level, double action_period_s, double episode_s,
                       const Eigen::Vector3d& target_ned, double radius_m, double start_distance_m,
                       double start_speed_m_s, double start_tilt_rad, double start_rate_rad_s,
                       double max_rate_rad_s, double max_tilt_rad, double max_speed_m_s,
                       double max_yaw_rate_rad_s) {
             HoverTask task;
             task.action_period_s = action_period_s;
             task.episode_s = episode_s;
             task.target_ned = target_ned;
             task.radius_m = radius_m;
             task.start_distance_m = start_distance_m;
             task.start_speed_m_s = start_speed_m_s;
             task.start_tilt_rad = start_tilt_rad;
             task.start_rate_rad_s = start_rate_rad_s;
             task.max_rate_rad_s = max_rate_rad_s;
             task.max_tilt_rad = max_tilt_rad;
             task.max_speed_m_s = max_speed_m_s;
             task.max_yaw_rate_rad_s = max_yaw_rate_rad_s;
             return make(count, threads, vehicle, simulation, dispersion, level, task);
           }),
           "count"_a, py::kw_only(), "threads"_a = 0, "vehicle"_a = "kaylion", "simulation"_a = "default",
           "dispersion"_a = "", "level"_a = "actuators", "action_period_s"_a = HoverTask().action_period_s,
           "episode_s"_a = HoverTask().episode_s, "target_ned"_a = HoverTask().target_ned,
           "radius_m"_a = HoverTask().radius_m, "start_distance_m"_a = HoverTask().start_distance_m,
           "start_speed_m_s"_a = HoverTask().start_speed_m_s, "start_tilt_rad"_a = HoverTask().start_tilt_rad,
           "start_rate_rad_s"_a = HoverTask().start_rate_rad_s,
           "max_rate_rad_s"_a = HoverTask().max_rate_rad_s, "max_tilt_rad"_a = HoverTask().max_tilt_rad,
           "max_speed_m_s"_a = HoverTask().max_speed_m_s,
           "max_yaw_rate_rad_s"_a = HoverTask().max_yaw_rate_rad_s)
      .def_property_readonly("count", &HoverEnvironments::count)
      .def_property_readonly("observation_size", &HoverEnvironments::observation_size)
      .def_property_readonly(
          "action_low", [](const HoverEnvironments& self) { return array_of(self.bounds().low); },
          "Shape (actions,): the lower bounds of an action.")
      .def_property_readonly(
          "action_high", [](const HoverEnvironments& self) { return array_of(self.bounds().high); },
          "Shape (actions,): the upper bounds of an action.")
      .def(
          "__deepcopy__",
          [](HoverEnvironments& self, const py::dict&) {
            const InUse use(self.in_use);
            return std::make_unique<HoverEnvironments>(self);
          },
          "memo"_a, "With the state of the episodes.")
      .def("reset", &reset, "seeds"_a = py::none(), "chosen"_a = py::none(),
           "seeds: (count,), of which the first episodes begin; without it the next episode of each. chosen: "
           "(count,), which environments; without it all. Returns the observations, shape (count, "
           "observation_size).")
      .def("step", &step, "actions"_a, "chosen"_a = py::none(),
           "actions: (count, actions). chosen: (count,), which environments; others are only observed. "
           "Returns observations, rewards, terminated, truncated, and the last "
           "observations of "
           "the episodes that ended, of which the next one has begun; zero elsewhere.");
}

}  // namespace swiftlet::python
