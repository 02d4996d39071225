// The whole flight of a vehicle as polynomials in time, from a dry run: where it is at each moment, on the ground
// included.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/ground/mission/dry_run.hpp"

namespace swiftlet::ground {

class FlightPath {
 public:
  struct Piece {
    double start_s = 0.0;  // since the start of the mission
    control::PolynomialSegment segment;

    double end_s() const { return start_s + segment.duration_s; }
  };

  // pieces: at least one, without gaps between them, the first at 0 s.
  explicit FlightPath(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}

  // start_ned: m, where the vehicle stands on the ground, z = 0, until its first leg. lands: the mission's last item is a
  // land: the vehicle then sinks from the last leg to the ground, and stands there.
  static FlightPath of(const MissionDryRun& flight, const Eigen::Vector2d& start_ned, bool lands);

  // m, NED, at any time: before 0 s the first position, after the end the last.
  Eigen::Vector3d at(double time_s) const;
  double duration_s() const { return pieces_.back().end_s(); }
  const std::vector<Piece>& pieces() const { return pieces_; }

  // The motion over start_s .. start_s + duration_s, which lies within one piece, or after the end. start_s >= 0.
  control::PolynomialSegment part(double start_s, double duration_s) const;

 private:
  const Piece& piece_at(double time_s) const;

  std::vector<Piece> pieces_;
};

// m/s: an upper bound of the speed on a segment, and on a path.
double greatest_speed(const control::PolynomialSegment& segment);
double greatest_speed(const FlightPath& path);

}  // namespace swiftlet::ground
