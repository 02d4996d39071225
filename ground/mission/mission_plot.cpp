#include "swiftlet/ground/mission/mission_plot.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/ground/report/gnuplot.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;

constexpr double kRow_s = 0.02;
constexpr double kDegrees = 180.0 / 3.14159265358979323846;
constexpr std::size_t kMaxLabels = 40;  // of places; more places get no labels

constexpr const char* kPlot = R"(
set terminal pngcairo size 1600,1150 font 'DejaVu Sans,12' noenhanced
set output 'mission.png'
set datafile separator ','
set multiplot title headline font 'DejaVu Sans,15'
set style line 1 lc rgb '#2f6fb0' lw 2.2            # the path
set style line 2 lc rgb '#b03a2e' lw 1.6 dt (8,6)   # limits and fence
set style line 3 lc rgb '#1a1a1a' pt 7 ps 0.9       # where items end
set style line 4 lc rgb '#cfcfcf' lw 0.8 dt (2,4)   # when they begin
set style line 9 lc rgb '#e2e2e2' lw 0.8
set grid ls 9
set border lc rgb '#555555'
set tics nomirror
csv = 'mission.csv'
unset key

set lmargin at screen 0.065
set rmargin at screen 0.520
set xrange [0:t_end]
set format x ''
set tmargin at screen 0.925; set bmargin at screen 0.735
set ylabel 'height -z (m)' offset 1
set label 1 'fence' at graph 0.985, first fence_top right offset 0,-0.7 tc ls 2
set yrange [height_from:height_to]
plot csv using 't':(-column('z')) with lines ls 1, fence_top with lines ls 2, fence_bottom with lines ls 2, \
     $items using 1:(height_to):(0):(height_from - height_to) with vectors nohead ls 4
set tmargin at screen 0.705; set bmargin at screen 0.515
set ylabel 'speed (m/s)'
set label 1 'limit' at graph 0.985, first speed_limit
set yrange [0:1.12 * speed_limit]
plot csv using 't':'speed' with lines ls 1, speed_limit with lines ls 2
set tmargin at screen 0.485; set bmargin at screen 0.295
set ylabel 'acceleration (m/s^2)'
set label 1 'limit' at graph 0.985, first acceleration_limit
set yrange [0:1.12 * acceleration_limit]
plot csv using 't':'acceleration' with lines ls 1, acceleration_limit with lines ls 2
set tmargin at screen 0.265; set bmargin at screen 0.065
set format x '%g'
set xlabel 'time (s)' offset 0,0.4
set ylabel 'tilt of the thrust (deg)'
set label 1 'limit' at graph 0.985, first tilt_limit
set yrange [0:1.12 * tilt_limit]
plot csv using 't':'tilt' with lines ls 1, tilt_limit with lines ls 2

set lmargin at screen 0.590; set rmargin at screen 0.975
set tmargin at screen 0.925; set bmargin at screen 0.500
unset label 1
set size ratio -1
set xlabel 'east y (m)' offset 0,0.4
set ylabel 'north x (m)' offset 1
set xrange [east_from:east_to]
set yrange [north_from:north_to]
plot $fence using 2:1 with lines ls 2, csv using 'y':'x' with lines ls 1, $places using 2:1 with points ls 3, \
     $places using 2:1:4 with labels left offset 0.6,0.6 tc rgb '#1a1a1a'

set size noratio
set lmargin at screen 0.600; set rmargin at screen 0.960
set tmargin at screen 0.430; set bmargin at screen 0.060
set view 62,35
set view equal xyz
set xyplane at 0
set zrange [0:height_to]
set xlabel 'east y (m)' offset 0,-0.5
set ylabel 'north x (m)' offset 0,-0.5
set zlabel 'height -z (m)' rotate by 90 offset -1
splot $fence_top using 2:1:3 with lines ls 2, $fence_posts using 2:1:3 with lines ls 2, \
      csv using 'y':'x':(-column('z')) with lines ls 1, $places using 2:1:3 with points ls 3
unset multiplot
)";

// A new temporary folder; the destructor removes it with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "swiftlet-plot.XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::system_error(errno, std::generic_category(), pattern);
    folder_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(folder_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

void write_csv(const fs::path& path, const MissionDryRun& dry_run) {
  runtime::CsvWriter csv(path, {"t", "x", "y", "z", "speed", "acceleration", "tilt"});
  for (const DryRunLeg& leg : dry_run.legs) {
    const double rows = std::ceil(leg.segment.duration_s / kRow_s);
    for (double i = 0.0; i <= rows; i += 1.0) {
      const double t_s = leg.segment.duration_s * i / rows;
      const control::Reference at = control::evaluate(leg.segment, t_s);
      const Eigen::Vector3d thrust = at.acceleration_ned - Eigen::Vector3d(0.0, 0.0, plant::kGravity);
      const double tilt = std::atan2(thrust.head<2>().norm(), -thrust.z()) * kDegrees;
      csv.number(leg.start_s + t_s).numbers(at.position_ned);
      csv.number(at.velocity_ned.norm()).number(at.acceleration_ned.norm()).number(tilt).end_row();
    }
  }
  csv.finish();
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

std::string block(const std::string& name, const std::string& rows) {
  return "$" + name + " << EOD\n" + rows + "EOD\n";
}

std::string corner(const control::Limits& limits, bool north, bool east, double height_m) {
  return fmt::format("{:.4f},{:.4f},{:.4f}\n", (north ? limits.fence_max_ned : limits.fence_min_ned).x(),
                     (east ? limits.fence_max_ned : limits.fence_min_ned).y(), height_m);
}

std::string fence_blocks(const control::Limits& limits) {
  const double top_m = -limits.fence_min_ned.z();
  std::string ring;
  std::string top;
  std::string posts;
  constexpr std::array<std::pair<bool, bool>, 5> kRound = {
      {{false, false}, {false, true}, {true, true}, {true, false}, {false, false}}};
  for (const auto& [north, east] : kRound) {
    ring += corner(limits, north, east, 0.0);
    top += corner(limits, north, east, top_m);
    posts += corner(limits, north, east, 0.0) + corner(limits, north, east, top_m) + "\n\n";
  }
  return block("fence", ring) + block("fence_top", top) + block("fence_posts", posts);
}

void write_script(const fs::path& path, const MissionFile& file, const MissionDryRun& dry_run,
                  const control::Limits& limits) {
  const std::vector<ItemEnd> places = places_of(dry_run);
  std::string place_rows;
  for (const ItemEnd& place : places) {
    const Eigen::Vector3d& p = place.position_ned;
    place_rows += fmt::format("{:.4f},{:.4f},{:.4f},\"{}\"\n", p.x(), p.y(), -p.z(),
                              places.size() <= kMaxLabels ? place.items.c_str() : "");
  }
  std::string starts;
  for (const double start_s : dry_run.item_starts_s) starts += fmt::format("{:.4f}\n", start_s);
  const auto range = [&](const char* name, int axis, double sign) {
    const double a = sign * limits.fence_min_ned[axis];
    const double b = sign * limits.fence_max_ned[axis];
    const double margin = 0.04 * std::abs(b - a);
    return fmt::format("{}_from = {:.4f}\n{}_to = {:.4f}\n", name, std::min(a, b) - margin, name,
                       std::max(a, b) + margin);
  };
  const std::string title = file.name + (file.description.empty() ? "" : " - " + file.description) +
                            fmt::format(": {:.1f} s, ", dry_run.duration_s) +
                            counted(file.mission.items.size(), "item");
  std::ofstream script(path);
  script << "headline = " << gnuplot_quoted(title) << "\n"
         << fmt::format("t_end = {:.4f}\n", dry_run.duration_s) << range("north", 0, 1.0)
         << range("east", 1, 1.0) << range("height", 2, -1.0)
         << fmt::format("fence_top = {:.4f}\nfence_bottom = {:.4f}\n", -limits.fence_min_ned.z(),
                        -limits.fence_max_ned.z())
         << fmt::format("speed_limit = {:.4f}\nacceleration_limit = {:.4f}\ntilt_limit = {:.4f}\n",
                        limits.max_speed, limits.max_acceleration, limits.max_tilt_rad * kDegrees)
         << block("places", place_rows) << block("items", starts) << fence_blocks(limits) << kPlot;
}

}  // namespace

std::string draw_mission(const fs::path& png, const MissionFile& file, const MissionDryRun& dry_run,
                         const control::Limits& settings) {
  const control::Limits limits = control::tightened(settings, file.mission.bounds);
  const TemporaryFolder temporary;
  write_csv(temporary.folder() / "mission.csv", dry_run);
  write_script(temporary.folder() / "mission.gp", file, dry_run, limits);
  std::string fault = run_gnuplot(temporary.folder(), "mission");
  if (!fault.empty()) return fault;
  std::error_code error;
  fs::copy_file(temporary.folder() / "mission.png", png, fs::copy_options::overwrite_existing, error);
  return error ? png.string() + " cannot be written: " + error.message() : "";
}

}  // namespace swiftlet::ground
