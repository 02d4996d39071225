#include "tests/bench/tracking_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/io/missions/mission_table.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::bench {
namespace {

using control::PolynomialSegment;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Position, velocity, acceleration and jerk in the plane.
struct Knot {
  Vector2d p = Vector2d::Zero();
  Vector2d v = Vector2d::Zero();
  Vector2d a = Vector2d::Zero();
  Vector2d j = Vector2d::Zero();
};

// The polynomial of degree 7 between two knots.
PolynomialSegment join(const Knot& from, const Knot& to, double duration_s) {
  Eigen::Matrix4d powers;  // of position, velocity, acceleration and jerk at the end, from t^4 on
  const double t = duration_s;
  for (int k = 0; k < 4; ++k) {
    const double n = k + 4;
    powers(0, k) = std::pow(t, n);
    powers(1, k) = n * std::pow(t, n - 1);
    powers(2, k) = n * (n - 1) * std::pow(t, n - 2);
    powers(3, k) = n * (n - 1) * (n - 2) * std::pow(t, n - 3);
  }
  const auto axis = [&](int i) {
    control::Polynomial c{from.p[i], from.v[i], from.a[i] / 2.0, from.j[i] / 6.0};
    Eigen::Vector4d rest;
    rest << to.p[i] - (c[0] + t * (c[1] + t * (c[2] + t * c[3]))),
        to.v[i] - (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3])), to.a[i] - (2.0 * c[2] + t * 6.0 * c[3]),
        to.j[i] - 6.0 * c[3];
    const Eigen::Vector4d high = powers.partialPivLu().solve(rest);
    for (std::size_t k = 0; k < 4; ++k) c[k + 4] = high[static_cast<Eigen::Index>(k)];
    return c;
  };
  PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = axis(0);
  segment.y = axis(1);
  segment.z[0] = -kHeight;
  return segment;
}

Vector3d at_height(const Vector2d& p) { return {p.x(), p.y(), -kHeight}; }

constexpr double kHold = 4.0;  // s before and after a square
constexpr double kSide = 8.0;  // s

std::array<Vector2d, 5> corners(double length) {
  return {Vector2d{0, 0}, Vector2d{length, 0}, Vector2d{length, length}, Vector2d{0, length}, Vector2d{0, 0}};
}

}  // namespace

Path square(const std::string& name, double length) {
  constexpr double kBlend = 0.22;  // s
  const auto at = corners(length);
  const auto knot = [at](double t) {
    const double u = std::clamp((t - kHold) / kSide, 0.0, 4.0);
    const auto side = static_cast<std::size_t>(std::min(std::floor(u), 3.0));
    const bool moves = t > kHold && t < kHold + 4.0 * kSide;
    const Vector2d along = at[side + 1] - at[side];
    return Knot{at[side] + (u - static_cast<double>(side)) * along,
                moves ? Vector2d(along / kSide) : Vector2d::Zero()};
  };
  Path path{name, [knot](double t) { return at_height(knot(t).p); }, {}, 0.0, 2.0 * kHold + 4.0 * kSide};
  double from = 0.0;
  for (int corner = 0; corner <= 4; ++corner) {
    const double t = kHold + kSide * corner;
    for (const double to : {t - kBlend, t + kBlend}) {
      path.trajectory.segments.push_back(join(knot(from), knot(to), to - from));
      from = to;
    }
  }
  path.trajectory.segments.push_back(join(knot(from), knot(path.score_to_s), path.score_to_s - from));
  return path;
}

Path minimum_jerk_square() {
  const auto at = corners(2.0);
  const auto hold = [](const Vector2d& p) { return join({p}, {p}, kHold); };
  control::Trajectory trajectory;
  trajectory.segments.push_back(hold(at[0]));
  for (std::size_t i = 0; i < 4; ++i) {
    trajectory.segments.push_back(
        control::minimum_jerk(at_height(at[i]), 0.0, at_height(at[i + 1]), 0.0, kSide));
  }
  trajectory.segments.push_back(hold(at[4]));
  return {"sq2j", {}, trajectory, 0.0, 2.0 * kHold + 4.0 * kSide};
}

Path figure_of_eight(const std::string& file, int laps) {
  const io::Table table = io::read_mission_table(io::read_text_file(file), file, "").table;
  Path path{"fig8", {}, {}, 0.0, 0.0};
  for (int lap = 0; lap < laps; ++lap) {
    for (std::size_t row = 0; row < table.row_count(); ++row) {
      PolynomialSegment segment;
      segment.duration_s = table.number(row, 0);
      for (std::size_t k = 0; k < segment.x.size(); ++k) {
        segment.y[k] = table.number(row, 1 + k);
        segment.x[k] = table.number(row, 9 + k);
        segment.z[k] = -table.number(row, 17 + k);
      }
      segment.z[0] -= kHeight;
      path.trajectory.segments.push_back(segment);
      path.score_to_s += segment.duration_s;
    }
  }
  return path;
}

Path lemniscate() {
  constexpr double kLap = 10.0;
  constexpr double kPiece = 0.5;
  constexpr int kPieces = 100;
  constexpr double kEnd = kPieces * kPiece;
  constexpr double kW = 2.0 * M_PI / kLap;
  const auto point = [](double phase) { return Vector2d(2.0 * std::sin(phase), std::sin(2.0 * phase)); };
  // Its rate rises from 0 to w as 10 s^3 - 15 s^4 + 6 s^5 does to 1.
  const auto phase = [](double t) {
    if (t >= kLap) return kW * (t - kLap / 2.0);
    const double s = t / kLap;
    return kW * kLap * s * s * s * s * (2.5 - 3.0 * s + s * s);
  };
  const auto knot = [&](double t) {
    // Derivatives by central differences of step h, exact to h^4.
    constexpr double kH = 2e-3;
    const auto f = [&](int n) { return point(phase(t + n * kH)); };
    const Vector2d v = (f(-2) - 8.0 * f(-1) + 8.0 * f(1) - f(2)) / (12.0 * kH);
    const Vector2d a = (-f(-2) + 16.0 * f(-1) - 30.0 * f(0) + 16.0 * f(1) - f(2)) / (12.0 * kH * kH);
    const Vector2d j = (-f(-2) + 2.0 * f(-1) - 2.0 * f(1) + f(2)) / (-2.0 * kH * kH * kH);
    return Knot{f(0), v, a, j};
  };
  Path path{"lem", [phase, point](double t) { return at_height(point(phase(t))); }, {}, kLap, kEnd};
  Knot from{point(0.0)};
  for (int piece = 1; piece <= kPieces; ++piece) {
    const Knot to = knot(kPiece * piece);
    path.trajectory.segments.push_back(join(from, to, kPiece));
    from = to;
  }
  return path;
}

Path faster(const Path& path, double factor) {
  Path out = path;
  if (path.position_ned)
    out.position_ned = [path, factor](double t) { return path.position_ned(factor * t); };
  for (PolynomialSegment& segment : out.trajectory.segments)
    segment = control::stretched(segment, 1.0 / factor);
  out.score_from_s /= factor;
  out.score_to_s /= factor;
  return out;
}

Vector3d reference_at(const control::Trajectory& trajectory, double t) {
  for (const PolynomialSegment& segment : trajectory.segments) {
    if (t <= segment.duration_s) return control::evaluate(segment, t).position_ned;
    t -= segment.duration_s;
  }
  return control::evaluate(trajectory.segments.back(), trajectory.segments.back().duration_s).position_ned;
}

}  // namespace swiftlet::bench
