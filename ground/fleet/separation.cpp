#include "swiftlet/ground/fleet/separation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "swiftlet/control/planning/bernstein.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kShortest_s = 1e-9;
constexpr double kTolerance = 1e-5;  // of the squared clearance, near 1

Eigen::Vector3d reach_of(const Ellipsoid& a, const Ellipsoid& b) {
  const double xy_m = a.radius_xy_m + b.radius_xy_m;
  return {xy_m, xy_m, a.radius_z_m + b.radius_z_m};
}

// The moments at which a piece of either path begins or ends.
std::vector<double> moments_of(const FlightPath& a, const FlightPath& b) {
  std::vector<double> moments = {0.0, std::max(a.duration_s(), b.duration_s())};
  for (const FlightPath* path : {&a, &b}) {
    for (const FlightPath::Piece& piece : path->pieces()) {
      moments.push_back(piece.start_s);
      moments.push_back(piece.end_s());
    }
  }
  std::sort(moments.begin(), moments.end());
  return moments;
}

control::Bernstein difference(const control::Polynomial& a, const control::Polynomial& b, double duration_s) {
  return control::bernstein(a, duration_s) - control::bernstein(b, duration_s);
}

}  // namespace

double clearance(const Ellipsoid& a, const Ellipsoid& b, const Eigen::Vector3d& from_a_to_b_m) {
  return from_a_to_b_m.cwiseQuotient(reach_of(a, b)).norm();
}

Approach closest_approach(const FlightPath& a, const Ellipsoid& around_a, const FlightPath& b,
                          const Ellipsoid& around_b) {
  const Eigen::Vector3d reach_m = reach_of(around_a, around_b);
  double least = std::numeric_limits<double>::infinity();  // squared
  double time_s = 0.0;
  const std::vector<double> moments = moments_of(a, b);
  for (std::size_t i = 0; i + 1 < moments.size(); ++i) {
    const double start_s = moments[i];
    const double duration_s = moments[i + 1] - start_s;
    if (duration_s <= kShortest_s) continue;
    const control::PolynomialSegment of_a = a.part(start_s, duration_s);
    const control::PolynomialSegment of_b = b.part(start_s, duration_s);
    const control::Bernstein squared =
        control::squared_length(1.0 / reach_m.x() * difference(of_a.x, of_b.x, duration_s),
                                1.0 / reach_m.y() * difference(of_a.y, of_b.y, duration_s),
                                1.0 / reach_m.z() * difference(of_a.z, of_b.z, duration_s));
    if (squared.least() >= least) continue;
    const control::Extremum nearest = control::minimum(squared, kTolerance);
    if (nearest.value >= least) continue;
    least = nearest.value;
    time_s = start_s + nearest.at * duration_s;
  }
  return {std::sqrt(std::max(least - kTolerance, 0.0)), time_s, a.at(time_s), b.at(time_s)};
}

}  // namespace swiftlet::ground
