#include "swiftlet/ground/fleet/flight_path.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/planning/bernstein.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kShortestRest_s = 1e-9;  // shorter gaps are the rounding of stamps to ns

control::PolynomialSegment straight(const Eigen::Vector3d& from_ned, const Eigen::Vector3d& to_ned,
                                    double duration_s) {
  const Eigen::Vector3d velocity = (to_ned - from_ned) / duration_s;
  control::PolynomialSegment segment;
  segment.duration_s = duration_s;
  segment.x = {from_ned.x(), velocity.x()};
  segment.y = {from_ned.y(), velocity.y()};
  segment.z = {from_ned.z(), velocity.z()};
  return segment;
}

// The polynomial of t + by_s, by Horner's scheme for each of its Taylor coefficients.
control::Polynomial shifted(control::Polynomial polynomial, double by_s) {
  for (std::size_t k = 0; k + 1 < polynomial.size(); ++k) {
    for (std::size_t i = polynomial.size() - 1; i-- > k;) polynomial[i] += by_s * polynomial[i + 1];
  }
  return polynomial;
}

}  // namespace

FlightPath FlightPath::of(const MissionDryRun& flight, const Eigen::Vector2d& start_ned, bool lands) {
  std::vector<Piece> pieces;
  double now_s = 0.0;
  Eigen::Vector3d at(start_ned.x(), start_ned.y(), 0.0);
  const auto move_until = [&](double end_s, const Eigen::Vector3d& to) {
    if (end_s - now_s <= kShortestRest_s) return;
    pieces.push_back({now_s, straight(at, to, end_s - now_s)});
    now_s = end_s;
    at = to;
  };
  for (const DryRunLeg& leg : flight.legs) {
    move_until(leg.start_s, at);
    pieces.push_back({now_s, leg.segment});
    now_s = pieces.back().end_s();
    at = control::evaluate(leg.segment, leg.segment.duration_s).position_ned;
  }
  Eigen::Vector3d end = at;
  if (lands) end.z() = 0.0;
  move_until(std::max(flight.duration_s, now_s + 2.0 * kShortestRest_s), end);
  return FlightPath(std::move(pieces));
}

const FlightPath::Piece& FlightPath::piece_at(double time_s) const {
  const auto later = std::upper_bound(pieces_.begin(), pieces_.end(), time_s,
                                      [](double t, const Piece& piece) { return t < piece.start_s; });
  return later == pieces_.begin() ? pieces_.front() : *std::prev(later);
}

Eigen::Vector3d FlightPath::at(double time_s) const {
  const Piece& piece = piece_at(time_s);
  return control::evaluate(piece.segment, time_s - piece.start_s).position_ned;
}

control::PolynomialSegment FlightPath::part(double start_s, double duration_s) const {
  // By the middle: the start may be the rounded end of the piece before.
  const Piece& piece = piece_at(start_s + 0.5 * duration_s);
  control::PolynomialSegment part;
  part.duration_s = duration_s;
  if (start_s + 0.5 * duration_s >= piece.end_s()) {
    const Eigen::Vector3d end = at(piece.end_s());
    part.x = {end.x()};
    part.y = {end.y()};
    part.z = {end.z()};
    return part;
  }
  const double since_s = start_s - piece.start_s;
  part.x = shifted(piece.segment.x, since_s);
  part.y = shifted(piece.segment.y, since_s);
  part.z = shifted(piece.segment.z, since_s);
  return part;
}

double greatest_speed(const control::PolynomialSegment& segment) {
  const auto rate = [&](const control::Polynomial& axis) {
    return control::bernstein(axis, segment.duration_s, 1);
  };
  return std::sqrt(control::squared_length(rate(segment.x), rate(segment.y), rate(segment.z)).greatest());
}

double greatest_speed(const FlightPath& path) {
  double greatest = 0.0;
  for (const FlightPath::Piece& piece : path.pieces())
    greatest = std::max(greatest, greatest_speed(piece.segment));
  return greatest;
}

}  // namespace swiftlet::ground
