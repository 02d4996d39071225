// The parts of the module swiftlet._core, a function for each, and what they have in common. They convert arguments and
// results; what they call is in the libraries.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>
#include <variant>
#include <vector>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/flight/flight_inputs.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/record/mcap/message_decoder.hpp"

namespace swiftlet::python {

namespace py = pybind11;

using WithoutGil = py::call_guard<py::gil_scoped_release>;
template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

// A model, or the name or file of one.
using VehicleArgument = std::variant<std::string, plant::Vehicle>;
using ControlArgument = std::variant<std::string, control::ControlSettings>;
using SimulationArgument = std::variant<std::string, plant::SimulationSettings>;

plant::Vehicle vehicle_of(const VehicleArgument& argument);
control::ControlSettings control_of(const ControlArgument& argument);
plant::SimulationSettings simulation_of(const SimulationArgument& argument);
plant::ControlLevel level_of(const std::string& text);

// The uncertainty of a vehicle file. Throws InputError of the module for a model, which has none.
struct FileUncertainty {
  std::string file;
  plant::VehicleUncertainty parameters;
};
FileUncertainty uncertainty_of(const VehicleArgument& argument);
[[noreturn]] void refuse_uncertainty_of_model();

const char* text_of(control::MissionState state);

// Throws InputError of the module.
[[noreturn]] void refuse(const std::string& sentence);
// Throws the exception of the module of this name ("RequestError") with the attribute `kind`. Needs the GIL.
[[noreturn]] void raise(const char* exception, const std::string& reason, const char* kind);
// Throws KeyboardInterrupt if the user has asked for it. Needs the GIL.
void check_signals();

// The longest wait for timeout_s. Throws InputError of the module if it is negative or not a number. Infinity is a year.
std::chrono::milliseconds limit_of(double timeout_s);

// Makes calls to an object exclusive. Throws RuntimeError if another thread is in one.
class InUse {
 public:
  explicit InUse(std::mutex& mutex);

 private:
  std::unique_lock<std::mutex> lock_;
};

// A copy. Shape (size) if columns is 0, else (size / columns, columns).
template <class T>
py::array_t<T> array_of(const std::vector<T>& values, std::size_t columns = 0) {
  if (columns == 0) return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
  return py::array_t<T>({values.size() / columns, columns}, values.data());
}

void add_errors(py::module_& module);
void add_models(py::module_& module);
void add_gains(py::module_& module);
void add_simulation(py::module_& module);
void add_stepped_simulation(py::module_& module);
void add_environments(py::module_& module);
void add_logs(py::module_& module);
void add_client(py::module_& module);

}  // namespace swiftlet::python
