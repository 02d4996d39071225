// Common parts of the readers of other projects' formats: their frame to NED, and a complete flight around a path.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/control/planning/waypoint_path.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/io/missions/mission_format.hpp"

namespace swiftlet::io {

control::PolynomialSegment ned_segment(MissionFrame frame, const control::PolynomialSegment& segment);

constexpr double kHoverHeight_m = 1.0;  // lowest point of a path that was raised
constexpr double kLeastHeight_m = 0.2;  // a path with a lower point is raised
constexpr double kApproachSpeed =
    0.5;  // m/s, largest speed of take-off, of the flight to the start of the path, and of landing

// Heights above z = 0, m.
struct Heights {
  double least_m = std::numeric_limits<double>::infinity();
  double greatest_m = -std::numeric_limits<double>::infinity();

  void add(double z_ned);
};

// Along the whole path.
Heights heights_of(const std::vector<control::PolynomialSegment>& segments);

// The frame in which a path was read, and whether that is assumed because neither the file nor --frame names one.
struct ReadFrame {
  MissionFrame frame;
  bool is_assumed;
};

// Returns by how much a path must be raised, m; 0 if it stays above kLeastHeight_m. Adds the decision to the
// assumptions. Throws io::ConfigError for a path that lies below the ground as a whole: its z probably
// points the other way; and for one that goes below the ground in an assumed frame: z could point either way.
double raise_by(const Heights& heights, ReadFrame read, const std::string& file_name,
                std::vector<std::string>& assumptions);

// Why a position is not in the air inside the fence; empty if it is.
std::string position_fault(const Eigen::Vector3d& position_ned, MissionFrame frame,
                           const control::Limits& limits);

// Why a path cannot be flown.
struct PathFault {
  std::size_t segment =
      0;  // the first that violates the fence or the limits, or does not continue the one before
  std::string reason;
  std::string advice;  // the option --time-scale with which it can be flown; empty: there is none

  std::string sentence() const { return advice.empty() ? reason : reason + "; " + advice; }
};

// Returns the path if it can be flown. Else calls `refuse`, which must throw.
TrajectoryFile checked(TrajectoryFile path, MissionFrame frame, const control::Limits& limits,
                       const FileOptions& options, const std::function<void(const PathFault&)>& refuse);

// Returns take-off to the height of the path's start, the path, and landing.
MissionFile whole_flight(const std::string& file_name, TrajectoryFile path, const control::Limits& limits);

// The least time scale at which the path is within the limits, a multiple of 0.01; nothing if there is none up to
// kLargestTimeScale.
std::optional<double> slower_within(const std::vector<control::PolynomialSegment>& segments,
                                    const control::Limits& limits);
constexpr double kLargestTimeScale = 20.0;

// "slower by 1.4: --time-scale 1.4"
std::string advice_of(double slower, const FileOptions& options);

control::MotionLimits reference_limits(const control::Limits& limits);

}  // namespace swiftlet::io
