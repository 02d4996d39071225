// `swiftlet set control`: changes the control settings of a running controller, also in flight.
#include <memory>
#include <string>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/request_command.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/fixed_settings.hpp"

namespace swiftlet::ground {
namespace {

struct SetOptions : RequestOptions {
  std::string file;
  double ramp_s = 2.0;
};

int set_control(const SetOptions& options) {
  const std::string file = io::configuration_file(io::kinds::kControl, options.file);
  const control::SettingsRequest request = control::settings_request(
      io::load_control_settings(file), io::load_fixed_settings(file), options.ramp_s);
  return run_request(
      options,
      {"set control", [&](Vehicle& vehicle) { return vehicle.change_settings(request, options.timeout()); },
       OnInterrupt::kNothing});
}

io::Command add_set_control_command(runtime::CommandLine set) {
  const auto options = std::make_shared<SetOptions>();
  const runtime::CommandLine app = add_request_subcommand(
      set, "control", "Change the gains to those of a control settings file, also in flight",
      "swiftlet set control mine.yaml --ramp 3", options);
  app.footer(
      "The gains are checked for stability and change smoothly. The other settings of the file must be those "
      "that\n"
      "the controller was started with (docs/tuning.md).\n\n" +
      app.footer());
  app.add_option("file", options->file, "control settings file, or the name of one in config/control")
      .type_name(io::kinds::kControl.value)
      .required();
  app.add_option("--ramp", options->ramp_s, "time over which the gains change, s")
      .range(control::kShortestGainChange_s, control::kLongestGainChange_s)
      .show_default();
  return {app, [options] { return set_control(*options); }};
}

}  // namespace

io::Command add_set_command(runtime::CommandLine root) {
  const runtime::CommandLine app = root.add_subcommand("set", "Change settings of a running vehicle");
  app.require_subcommand(1, 1);
  app.footer("example: swiftlet set control mine.yaml");
  const io::Command control = add_set_control_command(app);
  return {app, control.run};
}

}  // namespace swiftlet::ground
