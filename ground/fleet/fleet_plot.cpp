#include "swiftlet/ground/fleet/fleet_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "swiftlet/analysis/plot/path_figure.hpp"

namespace swiftlet::ground {
namespace {

using plot::Colour;
using plot::Style;

constexpr double kDrawnStep_s = 0.05;
constexpr std::size_t kClearance = 3;  // panel
constexpr double kFar = 10.0;          // clearance that counts as far
constexpr std::array kColours = {Colour::kBlue,   Colour::kOrange, Colour::kGreen,
                                 Colour::kPurple, Colour::kOchre,  Colour::kTeal,
                                 Colour::kBrown,  Colour::kInk,    Colour::kGrey};

}  // namespace

plot::Figure fleet_figure(const FleetCheck& check) {
  const std::string title =
      fmt::format("{}: {} vehicles, {:.0f} s{}", check.fleet.name, check.vehicles.size(), check.duration_s,
                  check.feasible() ? "" : " - CANNOT be flown");
  plot::Figure figure = plot::path_figure(
      title, {"north x (m)", "east y (m)", "height -z (m)", "least clearance, 1: two touch"},
      check.duration_s);
  plot::Series clearances{Style::kLine, Colour::kInk};
  const auto steps = static_cast<int>(std::ceil(check.duration_s / kDrawnStep_s));
  for (std::size_t i = 0; i < check.vehicles.size(); ++i) {
    const FleetVehicle& vehicle = check.vehicles[i];
    const plot::Series line{Style::kLine, kColours.at(i % kColours.size())};
    for (plot::Panel& panel : figure.panels) {
      if (&panel != &figure.panels[kClearance]) panel.series.push_back(line);
    }
    figure.panels[plot::kFromAbove].series.back().label = vehicle.member.name;
    for (int k = 0; k <= steps; ++k) {
      const double t_s = std::min(k * kDrawnStep_s, check.duration_s);
      const Eigen::Vector3d at = vehicle.path.at(t_s);
      const std::array<double, 3> values = {at.x(), at.y(), -at.z()};
      for (std::size_t axis = 0; axis < values.size(); ++axis)
        figure.panels[axis].series.back().points.push_back({t_s, values.at(axis)});
      for (const std::size_t view : {plot::kFromAbove, plot::kInSpace})
        figure.panels[view].series.back().points.push_back({at.y(), at.x(), -at.z()});
    }
  }
  for (int k = 0; k <= steps && check.vehicles.size() > 1; ++k) {
    const double t_s = std::min(k * kDrawnStep_s, check.duration_s);
    double least = kFar;
    for (const FleetPair& pair : check.pairs)
      least = std::min(least,
                       clearance(check.fleet.safety, check.fleet.safety,
                                 check.vehicles[pair.b].path.at(t_s) - check.vehicles[pair.a].path.at(t_s)));
    clearances.points.push_back({t_s, least});
  }
  figure.panels[plot::kFromAbove].title.clear();  // the legend is there
  figure.panels[kClearance].series = {
      clearances, {Style::kDashes, Colour::kRed, "", {{0.0, 1.0}, {check.duration_s, 1.0}}}};
  figure.panels[kClearance].y.from = 0.0;
  return figure;
}

}  // namespace swiftlet::ground
