// Vehicles, control settings and simulations: load, check, change, write.
#include <optional>

#include "bindings.hpp"

#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"

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

namespace {

// A text in Python for an enumeration of two values, of which the first is 0.
template <class Owner, class Enum>
auto text_property(py::class_<Owner>& owner, const char* name, Enum Owner::*member, const char* first,
                   const char* second, const char* doc) {
  owner.def_property(
      name, [=](const Owner& of) { return static_cast<int>(of.*member) == 0 ? first : second; },
      [=](Owner& of, const std::string& text) {
        if (text != first && text != second)
          refuse(std::string(name) + " is '" + text + "', must be '" + first + "' or '" + second + "'");
        of.*member = static_cast<Enum>(text == first ? 0 : 1);
      },
      doc);
}

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

  py::class_<plant::RotorCoefficients>(module, "RotorCoefficients", "Eq. (25) and (26).")
      .def_readwrite("thrust", &plant::RotorCoefficients::thrust, "k_T, N s^2.")
      .def_readwrite("torque", &plant::RotorCoefficients::torque, "k_Q, N m s^2.");

  py::class_<plant::Esc>(module, "Esc", "Eq. (8) and (9): v_a^2 = gain v_s^2 delta + offset.")
      .def_readwrite("gain", &plant::Esc::gain)
      .def_readwrite("offset_v2", &plant::Esc::offset_v2, "V^2.")
      .def_readwrite("pulse_min_us", &plant::Esc::pulse_min_us, "Pulse width at delta = 0, microseconds.")
      .def_readwrite("pulse_range_us", &plant::Esc::pulse_range_us, "From delta = 0 to 1, microseconds.");

  py::class_<plant::Motor> motor(module, "Motor", "Eq. (10)-(22).");
  text_property(motor, "model", &plant::Motor::model, "reduced", "physical",
                "'reduced': first order in speed, Eq. (18). 'physical': Eq. (10) and (15).");
  motor.def_readwrite("time_constant_s", &plant::Motor::time_constant_s, "tau_m of Eq. (18), s.")
      .def_readwrite("k2", &plant::Motor::k2, "K2 of Eq. (22), V s/rad.")
      .def_readwrite("k3", &plant::Motor::k3, "K3 of Eq. (22), V s^2/rad^2.")
      .def_readwrite("armature_resistance_ohm", &plant::Motor::armature_resistance_ohm, "R_a, ohm.")
      .def_readwrite("armature_inductance_h", &plant::Motor::armature_inductance_h, "L_a, H; 0: none.");

  py::class_<plant::BatteryParameters>(module, "Battery",
                                       "Open-circuit voltage over charge, and the sag under load.")
      .def_readwrite("capacity_ah", &plant::BatteryParameters::capacity_ah, "A h.")
      .def_readwrite("internal_resistance_ohm", &plant::BatteryParameters::internal_resistance_ohm, "ohm.")
      .def_readwrite("sag_time_constant_s", &plant::BatteryParameters::sag_time_constant_s, "s.")
      .def_readwrite("electronics_current_a", &plant::BatteryParameters::electronics_current_a,
                     "Of everything except the motors, A.")
      .def_readwrite("state_of_charge", &plant::BatteryParameters::state_of_charge,
                     "0 .. 1, ascending. A copy: assign a whole list.")
      .def_readwrite("open_circuit_voltage_v", &plant::BatteryParameters::open_circuit_voltage_v,
                     "At these states of charge, V. A copy: assign a whole list.");
}

void add_vehicle(py::module_& module) {
  using plant::Vehicle;
  py::class_<Vehicle> vehicle(module, "VehicleModel",
                              "The parameters of an identified vehicle, as in its file.");
  vehicle.def_readwrite("name", &Vehicle::name)
      .def_readwrite("mass_kg", &Vehicle::mass_kg, "kg.")
      .def_readwrite(
          "inertia", &Vehicle::inertia,
          "Shape (3, 3), kg m^2: in FRD about the centre of mass. Assign a whole array to change it.")
      .def_readwrite("linear_drag", &Vehicle::linear_drag, "N s/m, times the velocity relative to the air.")
      .def_property(
          "rotors", [](const Vehicle& self) { return py::tuple(py::cast(self.rotors)); },
          [](Vehicle& self, std::vector<plant::RotorMount> rotors) { self.rotors = std::move(rotors); },
          "The mounts of the rotors, a tuple.")
      .def_readwrite("rotor", &Vehicle::rotor)
      .def_readwrite("motor", &Vehicle::motor)
      .def_readwrite("esc", &Vehicle::esc)
      .def_readwrite("battery", &Vehicle::battery)
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
  py::class_<control::LqrWeights>(module, "LqrWeights", "Of one attitude axis.")
      .def_readwrite("q", &control::LqrWeights::q,
                     "Shape (3,): on angle, rate, and moment / inertia; rad^-2, (rad/s)^-2, (rad/s^2)^-2.")
      .def_readwrite("r", &control::LqrWeights::r, "On the commanded moment / inertia.");
  py::class_<control::AttitudeSettings> attitude(module, "AttitudeSettings", "The attitude law, LQR.");
  text_property(attitude, "model", &control::AttitudeSettings::model, "double_integrator", "motor_lag",
                "'double_integrator', Eq. (38)-(40), or 'motor_lag', with the rotor lag as third state.");
  text_property(attitude, "error", &control::AttitudeSettings::error, "euler_angles", "rotation",
                "'euler_angles', Eq. (29)-(31), or 'rotation'.");
  attitude.def_readwrite("roll", &control::AttitudeSettings::roll)
      .def_readwrite("pitch", &control::AttitudeSettings::pitch)
      .def_readwrite("yaw", &control::AttitudeSettings::yaw)
      .def_readwrite("feed_forward", &control::AttitudeSettings::feed_forward);
  py::class_<control::RptSettings>(module, "RptSettings", "Of one position axis, Eq. (49).")
      .def_readwrite("omega_n", &control::RptSettings::omega_n, "rad/s.")
      .def_readwrite("zeta", &control::RptSettings::zeta)
      .def_readwrite("epsilon", &control::RptSettings::epsilon)
      .def_readwrite("integral_pole", &control::RptSettings::integral_pole, "rad/s; 0: no integral.");
  py::class_<control::PositionSettings>(module, "PositionSettings", "The position law, RPT.")
      .def_readwrite("x", &control::PositionSettings::x)
      .def_readwrite("y", &control::PositionSettings::y)
      .def_readwrite("z", &control::PositionSettings::z)
      .def_readwrite("integral_limit", &control::PositionSettings::integral_limit, "m/s^2.");
  py::class_<control::DisturbanceSettings>(module, "DisturbanceSettings", "The disturbance observer.")
      .def_readwrite("bandwidth", &control::DisturbanceSettings::bandwidth, "rad/s; 0: off.")
      .def_readwrite("limit", &control::DisturbanceSettings::limit, "m/s^2.");
  py::class_<control::Limits>(module, "Limits", "Limits of flight.")
      .def_readwrite("max_tilt_rad", &control::Limits::max_tilt_rad)
      .def_readwrite("max_acceleration", &control::Limits::max_acceleration, "m/s^2, feedback command.")
      .def_readwrite("max_speed", &control::Limits::max_speed, "m/s, of planned references.")
      .def_readwrite("max_reference_acceleration", &control::Limits::max_reference_acceleration, "m/s^2.")
      .def_readwrite("max_reference_jerk", &control::Limits::max_reference_jerk, "m/s^3.")
      .def_readwrite("max_yaw_rate", &control::Limits::max_yaw_rate, "rad/s.")
      .def_readwrite("max_body_rate", &control::Limits::max_body_rate, "rad/s.")
      .def_readwrite("fence_min_ned", &control::Limits::fence_min_ned, "Shape (3,), m.")
      .def_readwrite("fence_max_ned", &control::Limits::fence_max_ned, "Shape (3,), m.")
      .def_readwrite("min_height_m", &control::Limits::min_height_m, "m above the ground.");
  py::class_<ControlSettings> settings(
      module, "ControlSettings",
      "The settings of the controller; those of estimator, arming and failsafes are as "
      "in the file.");
  settings.def_readwrite("name", &ControlSettings::name)
      .def_readwrite("attitude", &ControlSettings::attitude)
      .def_readwrite("position", &ControlSettings::position)
      .def_readwrite("disturbance", &ControlSettings::disturbance)
      .def_readwrite("limits", &ControlSettings::limits);
  add_validate(settings);
  add_copy(settings);
  module.def(
      "load_control", [](const std::string& name) { return control_of(name); }, "name"_a = "motor_lag",
      "Reads control settings. name: a path, or the name of a file in config/control. Throws InputError.");
}

void add_simulation_settings(py::module_& module) {
  using plant::SimulationSettings;
  py::class_<plant::ImuSettings>(module, "ImuSettings", "Noise densities as of data sheets.")
      .def_readwrite("rate_hz", &plant::ImuSettings::rate_hz)
      .def_readwrite("accelerometer_noise_density", &plant::ImuSettings::accelerometer_noise_density,
                     "m/s^2/sqrt(Hz).")
      .def_readwrite("gyro_noise_density", &plant::ImuSettings::gyro_noise_density, "rad/s/sqrt(Hz).")
      .def_readwrite("accelerometer_bias_sigma", &plant::ImuSettings::accelerometer_bias_sigma,
                     "m/s^2, once per run.")
      .def_readwrite("gyro_bias_sigma", &plant::ImuSettings::gyro_bias_sigma, "rad/s, once per run.")
      .def_readwrite("accelerometer_bias_walk", &plant::ImuSettings::accelerometer_bias_walk,
                     "m/s^2/sqrt(s).")
      .def_readwrite("gyro_bias_walk", &plant::ImuSettings::gyro_bias_walk, "rad/s/sqrt(s).");
  py::class_<plant::MocapSettings>(module, "MocapSettings", "Motion capture.")
      .def_readwrite("rate_hz", &plant::MocapSettings::rate_hz)
      .def_readwrite("latency_s", &plant::MocapSettings::latency_s, "From exposure to delivery, s.")
      .def_readwrite("position_error_m", &plant::MocapSettings::position_error_m, "m.")
      .def_readwrite("orientation_error_rad", &plant::MocapSettings::orientation_error_rad, "rad.")
      .def_readwrite("misalignment_rad", &plant::MocapSettings::misalignment_rad, "rad.")
      .def_readwrite("dropout_probability", &plant::MocapSettings::dropout_probability, "Of a frame.")
      .def_readwrite("dropout_length_s", &plant::MocapSettings::dropout_length_s, "s.");
  py::class_<plant::RadioSettings>(module, "RadioSettings", "Between vehicle and ground, each way.")
      .def_readwrite("delay_s", &plant::RadioSettings::delay_s, "s.")
      .def_readwrite("jitter_s", &plant::RadioSettings::jitter_s, "s, at most, in addition.")
      .def_readwrite("loss", &plant::RadioSettings::loss, "Probability that a packet is lost.");
  py::class_<plant::SupplySettings>(module, "SupplySettings", "The battery in the simulation.")
      .def_readwrite("ideal", &plant::SupplySettings::ideal, "True: the voltage is constant.")
      .def_readwrite("initial_state_of_charge", &plant::SupplySettings::initial_state_of_charge, "0 .. 1.");
  py::class_<plant::AirSettings>(module, "AirSettings", "Drag, wind and gusts.")
      .def_readwrite("drag", &plant::AirSettings::drag, "True: the linear drag of the vehicle applies.")
      .def_readwrite("wind_ned", &plant::AirSettings::wind_ned, "Shape (3,), m/s.")
      .def_readwrite("gust_sigma_ned", &plant::AirSettings::gust_sigma_ned, "Shape (3,), m/s.")
      .def_readwrite("gust_time_constant_s", &plant::AirSettings::gust_time_constant_s, "s.");
  py::class_<plant::GroundSettings>(module, "GroundSettings", "The floor.")
      .def_readwrite("present", &plant::GroundSettings::present)
      .def_readwrite("leg_height_m", &plant::GroundSettings::leg_height_m, "m.")
      .def_readwrite("friction", &plant::GroundSettings::friction);
  py::class_<SimulationSettings> settings(module, "SimulationSettings",
                                          "The settings of the simulation; faults are as in the file.");
  settings.def_readwrite("name", &SimulationSettings::name)
      .def_property(
          "step_s", [](const SimulationSettings& self) { return 1e-9 * static_cast<double>(self.step_ns); },
          [](SimulationSettings& self, double step_s) {
            if (!(step_s > 0.0 && step_s <= 1.0)) refuse("step_s must be above 0 and at most 1");
            self.step_ns = static_cast<std::int64_t>(step_s * 1e9 + 0.5);
          },
          "Integration step, s.")
      .def_readwrite("command_timeout_s", &SimulationSettings::command_timeout_s, "s.")
      .def_readwrite("command_hold_s", &SimulationSettings::command_hold_s, "s.")
      .def_readwrite("rotor_speed_rate_hz", &SimulationSettings::rotor_speed_rate_hz, "0: not measured.")
      .def_readwrite("imu", &SimulationSettings::imu)
      .def_readwrite("mocap", &SimulationSettings::mocap)
      .def_readwrite("radio", &SimulationSettings::radio)
      .def_readwrite("supply", &SimulationSettings::supply)
      .def_readwrite("air", &SimulationSettings::air)
      .def_readwrite("ground", &SimulationSettings::ground);
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
