#include "swiftlet/ground/fleet/right_of_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace swiftlet::ground {
namespace {

constexpr double kLeastReach_m = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t cell_of(double path_time_s) {
  return static_cast<std::size_t>(std::max(path_time_s, 0.0) / RightOfWay::kCell_s);
}

}  // namespace

RightOfWay::Cells RightOfWay::cells_of(const FlightPath& path) {
  Cells cells;
  const auto count = static_cast<std::size_t>(std::ceil(path.duration_s() / kCell_s)) + 1;
  cells.reach_m.assign(count, 0.0);
  for (std::size_t k = 0; k < count; ++k)
    cells.centres.push_back(path.at((static_cast<double>(k) + 0.5) * kCell_s));
  for (const FlightPath::Piece& piece : path.pieces()) {
    const double reach_m = 0.5 * kCell_s * greatest_speed(piece.segment);
    const std::size_t last = std::min(cell_of(piece.end_s()), count - 1);
    for (std::size_t k = cell_of(piece.start_s); k <= last; ++k)
      cells.reach_m[k] = std::max(cells.reach_m[k], reach_m);
  }
  return cells;
}

RightOfWay::RightOfWay(const std::vector<Vehicle>& vehicles)
    : awaited_(vehicles.size(), std::vector<std::vector<std::int32_t>>(vehicles.size())) {
  for (const Vehicle& vehicle : vehicles) cells_.push_back(cells_of(vehicle.path));
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const Ellipsoid& own_ellipsoid = vehicles[i].around;
    const Cells& own = cells_[i];
    for (std::size_t j = 0; j < vehicles.size(); ++j) {
      std::vector<std::int32_t>& awaited = awaited_[i][j];
      awaited.assign(own.centres.size(), -1);
      if (i == j) continue;
      const Cells& other = cells_[j];
      // In units of the narrower radius, a length of 1 m is at most 1 / narrow_m.
      const Ellipsoid& other_ellipsoid = vehicles[j].around;
      const double narrow_m = std::min(own_ellipsoid.radius_xy_m + other_ellipsoid.radius_xy_m,
                                       own_ellipsoid.radius_z_m + other_ellipsoid.radius_z_m);
      const double longest_m = *std::max_element(other.reach_m.begin(), other.reach_m.end());
      for (std::size_t k = 0; k < own.centres.size(); ++k) {
        auto m = static_cast<std::int32_t>(std::min(k, other.centres.size())) - 1;
        while (m >= 0) {
          const auto there = static_cast<std::size_t>(m);
          const double apart =
              clearance(own_ellipsoid, other_ellipsoid, other.centres[there] - own.centres[k]);
          if (apart <= 1.0 + (own.reach_m[k] + other.reach_m[there]) / narrow_m) break;
          // From cell to cell the other one moves by at most twice its reach: it is still apart in these.
          const double spare_m = (apart - 1.0) * narrow_m - own.reach_m[k] - longest_m;
          const double skipped = std::min(spare_m / (2.0 * longest_m + kLeastReach_m), 1e6);
          m -= 1 + std::max(static_cast<std::int32_t>(skipped), 0);
        }
        awaited[k] = std::max(m, -1);
      }
      // A vehicle cannot wait while it lands: it waits before its landing for every vehicle that it would meet there.
      const auto landing = awaited.begin() + static_cast<std::ptrdiff_t>(
                                                 std::min(cell_of(vehicles[i].lands_s), awaited.size() - 1));
      *landing = *std::max_element(landing, awaited.end());
    }
  }
}

double RightOfWay::limit_s(std::size_t i, const std::vector<double>& progress_s, std::size_t& blocker) const {
  std::size_t limit = cells_[i].centres.size();
  for (std::size_t j = 0; j < cells_.size(); ++j) {
    const std::size_t there = cell_of(progress_s[j]);
    const bool has_ended =
        there + 2 >= cells_[j].centres.size();  // the last cell is the place of its landing
    if (j == i || has_ended) continue;
    const auto passed = static_cast<std::int32_t>(there);
    const std::vector<std::int32_t>& awaited = awaited_[i][j];
    for (std::size_t k = cell_of(progress_s[i]) + 1; k < limit; ++k) {
      if (awaited[k] < passed) continue;
      limit = k;
      blocker = j;
      break;
    }
  }
  return limit == cells_[i].centres.size() ? kInfinity : static_cast<double>(limit) * kCell_s;
}

RightOfWay::Slack RightOfWay::least_slack(const std::vector<double>& needed_s) const {
  Slack least{kInfinity, 0, 0, 0.0};
  double least_spare_s = kInfinity;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    for (std::size_t j = 0; j < cells_.size(); ++j) {
      for (std::size_t k = 0; k < awaited_[i][j].size(); ++k) {
        if (awaited_[i][j][k] < 0) continue;
        const double slack_s = (static_cast<double>(k) - awaited_[i][j][k] - 1.0) * kCell_s;
        if (slack_s - needed_s[i] >= least_spare_s) continue;
        least_spare_s = slack_s - needed_s[i];
        least = {slack_s, j, i, static_cast<double>(k) * kCell_s};
      }
    }
  }
  return least;
}

}  // namespace swiftlet::ground
