// The control design with its gains and margins, as `swiftlet gains` prints it.
#include "bindings.hpp"

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/flown_delay.hpp"
#include "swiftlet/ground/batch/gains_report.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;

// The uncertainty of a vehicle file; none of a model that is in no file.
simulation::Dispersion dispersion_of(const VehicleArgument& argument, const plant::Vehicle& vehicle) {
  if (!std::holds_alternative<std::string>(argument)) return {};
  const FileUncertainty of = uncertainty_of(argument);
  return of.parameters.parameters.empty() ? simulation::Dispersion{}
                                          : simulation::dispersion_of(of.parameters, vehicle, of.file);
}

using Report = std::string (*)(const control::ControlDesign&, const ground::MarginStudy&,
                               const ground::FlownDelays&, const std::string&, const std::string&);

std::string report_of(const VehicleArgument& vehicle_argument, const ControlArgument& control_argument,
                      std::size_t samples, std::uint64_t seed, Report report) {
  const plant::Vehicle vehicle = vehicle_of(vehicle_argument);
  const control::ControlSettings settings = control_of(control_argument);
  const control::ControlDesign design = control::design(vehicle, settings);
  const ground::MarginStudy margins =
      ground::study_margins(design, vehicle, dispersion_of(vehicle_argument, vehicle), samples, seed);
  return report(design, margins, control::flown_delay_margins(design, settings), vehicle.name, settings.name);
}

}  // namespace

void add_gains(py::module_& module) {
  module.def(
      "gains_json",
      [](const VehicleArgument& vehicle, const ControlArgument& control, std::size_t samples,
         std::uint64_t seed) { return report_of(vehicle, control, samples, seed, &ground::gains_json); },
      "vehicle"_a = "kaylion", "control"_a = "motor_lag", py::kw_only(), "samples"_a = 1000, "seed"_a = 1,
      WithoutGil(), "What `swiftlet gains --json` prints. See gains() of swiftlet.");
  module.def(
      "gains_table",
      [](const VehicleArgument& vehicle, const ControlArgument& control, std::size_t samples,
         std::uint64_t seed) { return report_of(vehicle, control, samples, seed, &ground::gains_table); },
      "vehicle"_a = "kaylion", "control"_a = "motor_lag", py::kw_only(), "samples"_a = 1000, "seed"_a = 1,
      WithoutGil(), "The table that `swiftlet gains` prints. Arguments as of gains().");
  module.def(
      "unstable_loops",
      [](const VehicleArgument& vehicle, const ControlArgument& control) {
        return control::unstable_loops(control::design(vehicle_of(vehicle), control_of(control)));
      },
      "vehicle"_a = "kaylion", "control"_a = "motor_lag",
      "The loops of a design that are unstable with the rotor lag; empty if it can be flown.");
}

}  // namespace swiftlet::python
