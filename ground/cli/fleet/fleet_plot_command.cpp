#include <cstdio>
#include <memory>
#include <string>

#include "swiftlet/analysis/plot/gnuplot.hpp"
#include "swiftlet/ground/cli/fleet/fleet_commands.hpp"
#include "swiftlet/ground/fleet/fleet_check.hpp"
#include "swiftlet/ground/fleet/fleet_plot.hpp"
#include "swiftlet/io/configuration.hpp"

namespace swiftlet::ground {
namespace {

struct FleetPlotOptions {
  std::string file;
  std::string output = "fleet.png";
};

int plot_fleet_file(const FleetPlotOptions& options) {
  const FleetCheck check =
      check_fleet(load_fleet_file(io::configuration_file(io::kinds::kFleet, options.file)));
  if (!check.feasible())
    std::fprintf(stderr, "swiftlet: %s: %s\n", check.fleet.name.c_str(), check.refusal().c_str());
  const std::string fault = plot::draw_png(fleet_figure(check), options.output);
  if (!fault.empty()) {
    std::fprintf(stderr, "swiftlet: %s\n", fault.c_str());
    return io::kFailed;
  }
  std::printf("%s: wrote %s, %.1f s of flight\n", check.fleet.name.c_str(), options.output.c_str(),
              check.duration_s);
  return check.feasible() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_fleet_plot_command(runtime::CommandLine fleet) {
  const auto options = std::make_shared<FleetPlotOptions>();
  const runtime::CommandLine app = fleet.add_subcommand(
      "plot", "Draw the paths of a fleet file, and how near the vehicles come to each other");
  app.footer("example: swiftlet fleet plot swap6 -o swap6.png");
  app.add_option("file", options->file, "fleet file, or the name of one in config/fleets")
      .type_name(io::kinds::kFleet.value)
      .required();
  app.add_option("-o,--out", options->output, "PNG file").show_default();
  return {app, [options] { return plot_fleet_file(*options); }};
}

}  // namespace swiftlet::ground
