#include "swiftlet/ground/mission/mission_plot.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/analysis/plot/gnuplot.hpp"
#include "swiftlet/analysis/plot/path_figure.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {
namespace {

using plot::Colour;
using plot::Style;

constexpr double kFigureStep_s = 0.02;
constexpr std::size_t kMaxLabels = 40;  // of places; more places get no labels

plot::Point seen(const Eigen::Vector3d& position_ned) {
  return {position_ned.y(), position_ned.x(), -position_ned.z()};
}

// Height, speed, acceleration and tilt over time, and the path.
void add_motion(plot::Figure& figure, const MissionDryRun& dry_run) {
  for (plot::Panel& panel : figure.panels) panel.series.emplace_back();
  for (const DryRunLeg& leg : dry_run.legs) {
    const double steps = std::ceil(leg.segment.duration_s / kFigureStep_s);
    for (double i = 0.0; i <= steps; i += 1.0) {
      const double t_s = leg.segment.duration_s * i / steps;
      const control::Reference at = control::evaluate(leg.segment, t_s);
      const Eigen::Vector3d thrust = at.acceleration_ned - Eigen::Vector3d(0.0, 0.0, plant::kGravity);
      const std::array<double, 4> values = {
          -at.position_ned.z(), at.velocity_ned.norm(), at.acceleration_ned.norm(),
          std::atan2(thrust.head<2>().norm(), -thrust.z()) * math::kDegPerRad};
      for (std::size_t k = 0; k < values.size(); ++k)
        figure.panels[k].series.back().points.push_back({leg.start_s + t_s, values[k]});
      for (const std::size_t view : {plot::kFromAbove, plot::kInSpace})
        figure.panels[view].series.back().points.push_back(seen(at.position_ned));
    }
  }
}

// A horizontal line over the whole time, with its name at the right.
void add_limit(plot::Panel& panel, double limit, const char* name) {
  panel.series.push_back({Style::kDashes, Colour::kRed, "", {{*panel.x.from, limit}, {*panel.x.to, limit}}});
  panel.labels.push_back({{*panel.x.to, limit}, name, Colour::kRed, true});
}

// The fence as a ring, from above, and as a box, in space.
void add_fence(plot::Figure& figure, const control::Limits& limits) {
  const plot::Point from = seen(limits.fence_min_ned);
  const plot::Point to = seen(limits.fence_max_ned);
  plot::Series ring{Style::kDashes, Colour::kRed};
  plot::Series posts = ring;
  for (const auto& [east, north] : {std::pair{from.x, from.y}, std::pair{to.x, from.y}, std::pair{to.x, to.y},
                                    std::pair{from.x, to.y}, std::pair{from.x, from.y}}) {
    ring.points.push_back({east, north, from.z});
    posts.points.insert(posts.points.end(), {{east, north, 0.0}, {east, north, from.z}, plot::kGap});
  }
  plot::add_to_views(figure, ring);
  figure.panels[plot::kInSpace].series.push_back(posts);
  add_limit(figure.panels[0], from.z, "fence");
  add_limit(figure.panels[0], to.z, "");
}

// A place where items end, with their numbers: "2", or "2, 5" if several end there.
struct ItemEnd {
  Eigen::Vector3d position_ned;
  std::string items;
};

std::vector<ItemEnd> places_of(const MissionDryRun& dry_run) {
  constexpr double kSamePlace_m = 0.02;
  std::vector<ItemEnd> places;
  for (std::size_t i = 0; i < dry_run.legs.size(); ++i) {
    const DryRunLeg& leg = dry_run.legs[i];
    if (i + 1 < dry_run.legs.size() && dry_run.legs[i + 1].item == leg.item) continue;
    const Eigen::Vector3d end = control::evaluate(leg.segment, leg.segment.duration_s).position_ned;
    const std::string number = std::to_string(leg.item + 1);
    ItemEnd* same = nullptr;
    for (ItemEnd& place : places) {
      if ((place.position_ned - end).head<2>().norm() < kSamePlace_m) same = &place;
    }
    if (same == nullptr) {
      places.push_back({end, number});
    } else {
      same->items += ", " + number;
    }
  }
  return places;
}

void add_places(plot::Figure& figure, const MissionDryRun& dry_run) {
  const std::vector<ItemEnd> places = places_of(dry_run);
  plot::Series dots{Style::kDots, Colour::kInk, "", {}, 1.3};
  for (const ItemEnd& place : places) {
    dots.points.push_back(seen(place.position_ned));
    if (places.size() <= kMaxLabels)
      figure.panels[plot::kFromAbove].labels.push_back({dots.points.back(), place.items});
  }
  plot::add_to_views(figure, dots);
}

plot::Figure mission_figure(const io::MissionFile& file, const MissionDryRun& dry_run,
                            const control::Limits& limits) {
  const std::string title = file.name + (file.description.empty() ? "" : " - " + file.description) +
                            fmt::format(": {:.1f} s, ", dry_run.duration_s) +
                            io::counted(file.mission.items.size(), "item");
  plot::Figure figure = plot::path_figure(
      title, {"height -z (m)", "speed (m/s)", "acceleration (m/s^2)", "tilt of the thrust (deg)"},
      dry_run.duration_s);
  add_fence(figure, limits);
  plot::Series starts{Style::kDashes, Colour::kGrey, "", {}, 0.5};
  for (const double at_s : dry_run.item_starts_s)
    starts.points.insert(starts.points.end(),
                         {{at_s, -limits.fence_max_ned.z()}, {at_s, -limits.fence_min_ned.z()}, plot::kGap});
  figure.panels[0].series.push_back(starts);
  add_limit(figure.panels[1], limits.max_speed, "limit");
  add_limit(figure.panels[2], limits.max_acceleration, "limit");
  add_limit(figure.panels[3], limits.max_tilt_rad * math::kDegPerRad, "limit");
  for (const std::size_t panel : {1, 2, 3}) figure.panels[panel].y.from = 0.0;
  add_motion(figure, dry_run);
  add_places(figure, dry_run);
  return figure;
}

}  // namespace

std::string draw_mission(const std::filesystem::path& png, const io::MissionFile& file,
                         const MissionDryRun& dry_run, const control::Limits& settings) {
  return plot::draw_png(mission_figure(file, dry_run, control::tightened(settings, file.mission.bounds)),
                        png);
}

}  // namespace swiftlet::ground
