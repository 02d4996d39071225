// Vehicles, control settings and simulations: load, check, change, write.
#include <optional>

#include "settings_class.hpp"

#include "swiftlet/control/types/settings_visit.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"
#include "swiftlet/plant/model/vehicle_visit.hpp"
#include "swiftlet/plant/simulation/settings_visit.hpp"

namespace swiftlet::python {

using namespace py::literals;

plant::Vehicle vehicle_of(const VehicleArgument& argument) {
  if (const auto* vehicle = std::get_if<plant::Vehicle>(&argument)) return *vehicle;
  return io::load_vehicle(io::configuration_file(io::kinds::kVehicle, std::get<std::string>(argument)));
}

control::ControlSettings control_of(const ControlArgument& argument) {
  if (const auto* settings = std::get_if<control::ControlSettings>(&argument)) return *settings;
  return io::load_control_settings(
      io::configuration_file(io::kinds::kControl, std::get<std::string>(argument)));
}

plant::SimulationSettings simulation_of(const SimulationArgument& argument) {
  if (const auto* settings = std::get_if<plant::SimulationSettings>(&argument)) return *settings;
  return io::load_simulation_settings(
      io::configuration_file(io::kinds::kSimulation, std::get<std::string>(argument)));
}

plant::ControlLevel level_of(const std::string& text) {
  const auto level = plant::control_level_from(text);
  if (!level) refuse("level is '" + text + "', must be 'actuators', 'rates', 'attitude' or 'trajectory'");
  return *level;
}

void refuse_uncertainty_of_model() {
  refuse("dispersion 'uncertainty' is that of a vehicle file, which a model has not: name the file");
}

FileUncertainty uncertainty_of(const VehicleArgument& argument) {
  const auto* const name = std::get_if<std::string>(&argument);
  if (name == nullptr) refuse_uncertainty_of_model();
  const std::string file = io::configuration_file(io::kinds::kVehicle, *name).string();
  return {file, io::load_vehicle_uncertainty(file)};
}

template <>
std::string class_name<plant::BatteryParameters>() {
  return "Battery";
}
template <>
std::string class_name<control::OdometrySettings>() {
  return "OdometryUse";
}

namespace {

template <class T>
void add_copy(py::class_<T>& type) {
  type.def(
      "copy", [](const T& self) { return T(self); }, "An independent copy.");
}

template <class T>
void add_validate(py::class_<T>& type) {
  type.def(
      "validate", [](const T& self) { return validate(self); },
      "The rules that it breaks; empty if it can be used.");
}

void add_vehicle_parts(py::module_& module) {
  py::class_<plant::Violation>(module, "Violation", "A rule that a model breaks.")
      .def_readonly("key", &plant::Violation::key, "As in the file: 'motor.time_constant'.")
      .def_readonly("message", &plant::Violation::message, "With value and limit: 'is -0.1, must be ...'.")
      .def("__repr__", [](const plant::Violation& self) { return self.key + ": " + self.message; });

  py::class_<plant::RotorMount> mount(module, "RotorMount",
                                      "Place and sense of rotation of a rotor. Not changeable.");
  mount
      .def(py::init([](const Eigen::Vector3d& position_frd, const std::string& spin) {
             if (spin != "counter_clockwise" && spin != "clockwise")
               refuse("spin is '" + spin + "', must be 'counter_clockwise' or 'clockwise'");
             return plant::RotorMount{position_frd, spin == "clockwise" ? plant::Spin::kClockwise
                                                                        : plant::Spin::kCounterClockwise};
           }),
           "position_frd"_a, "spin"_a)
      .def_readonly("position_frd", &plant::RotorMount::position_frd,
                    "Shape (3,), m: hub relative to the centre of mass, FRD.")
      .def_property_readonly(
          "spin",
          [](const plant::RotorMount& self) {
            return self.spin == plant::Spin::kClockwise ? "clockwise" : "counter_clockwise";
          },
          "'counter_clockwise' or 'clockwise', seen from above.");
}

void add_vehicle(py::module_& module) {
  using plant::Vehicle;
  auto vehicle = settings_class<Vehicle>(module, "VehicleModel",
                                         "The parameters of an identified vehicle, as in its file.");
  vehicle.def_readwrite("name", &Vehicle::name)
      .def_property(
          "rotors", [](const Vehicle& self) { return py::tuple(py::cast(self.rotors)); },
          [](Vehicle& self, std::vector<plant::RotorMount> rotors) { self.rotors = std::move(rotors); },
          "The mounts of the rotors, a tuple.")
      .def_property_readonly("rotor_count", &Vehicle::rotor_count)
      .def(
          "text",
          [](const Vehicle& self, const std::string& comment) {
            return io::vehicle_text(self, {}, {}, comment);
          },
          "comment"_a = "",
          "The text of a vehicle file, from which parse_vehicle() makes an equal model. Every source is "
          "'estimate'.");
  add_validate(vehicle);
  add_copy(vehicle);

  module.def(
      "load_vehicle", [](const std::string& name) { return vehicle_of(name); }, "name"_a = "kaylion",
      "Reads a vehicle file. name: a path, or the name of one in config/vehicles. Throws InputError.");
  module.def(
      "parse_vehicle",
      [](const std::string& text, const std::string& file_name) {
        return io::parse_vehicle(text, file_name);
      },
      "text"_a, "file_name"_a = "vehicle",
      "Reads the text of a vehicle file. file_name: for messages. Throws InputError.");
}

void add_control(py::module_& module) {
  using control::ControlSettings;
  auto settings = settings_class<ControlSettings>(module, "ControlSettings",
                                                  "The settings of the controller, as in the file.");
  settings.def_readwrite("name", &ControlSettings::name);
  add_validate(settings);
  add_copy(settings);
  module.def(
      "load_control", [](const std::string& name) { return control_of(name); }, "name"_a = "motor_lag",
      "Reads control settings. name: a path, or the name of a file in config/control. Throws InputError.");
}

void add_simulation_settings(py::module_& module) {
  using plant::SimulationSettings;
  auto settings = settings_class<SimulationSettings>(
      module, "SimulationSettings", "The settings of the simulation; faults are as in the file.");
  settings.def_readwrite("name", &SimulationSettings::name)
      .def_property(
          "step_s", [](const SimulationSettings& self) { return 1e-9 * static_cast<double>(self.step_ns); },
          [](SimulationSettings& self, double step_s) {
            if (!(step_s > 0.0 && step_s <= 1.0)) refuse("step_s must be above 0 and at most 1");
            self.step_ns = static_cast<std::int64_t>(step_s * 1e9 + 0.5);
          },
          "Integration step, s.");
  add_validate(settings);
  add_copy(settings);
  module.def(
      "load_simulation", [](const std::string& name) { return simulation_of(name); }, "name"_a = "default",
      "Reads a simulation file. name: a path, or the name of one in config/simulation. Throws InputError.");
}

void add_missions(py::module_& module) {
  py::class_<io::MissionFile>(module, "Mission", "A mission, read from a file or a text.")
      .def_readonly("name", &io::MissionFile::name)
      .def_readonly("description", &io::MissionFile::description)
      .def_readonly("tolerance_m", &io::MissionFile::tolerance_m,
                    "Largest peak error of a completed flight, m.")
      .def_readonly("assumptions", &io::MissionFile::assumptions,
                    "Made in reading a file of another project.")
      .def_property_readonly("item_count",
                             [](const io::MissionFile& self) { return self.mission.items.size(); });
  module.def(
      "load_mission",
      [](const std::string& name, const ControlArgument& control) {
        return io::load_mission_file(io::configuration_file(io::kinds::kMission, name),
                                     control_of(control).limits);
      },
      "name"_a = "square", "control"_a = "motor_lag",
      "Reads a mission file, also one of another project. name: a path, or the name of one in "
      "config/missions. It is "
      "checked by the limits of the control settings. Throws InputError.");
  module.def(
      "parse_mission",
      [](const std::string& text, const ControlArgument& control, const std::string& file_name) {
        return io::parse_mission_file(text, file_name, control_of(control).limits);
      },
      "text"_a, "control"_a = "motor_lag", "file_name"_a = "mission",
      "Reads the text of a mission file in YAML. Throws InputError.");
}

}  // namespace

void add_models(py::module_& module) {
  add_vehicle_parts(module);
  add_vehicle(module);
  add_control(module);
  add_simulation_settings(module);
  add_missions(module);
}

}  // namespace swiftlet::python
