#include "swiftlet/ground/vehicle_check/axes.hpp"

#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/math/angles.hpp"

namespace swiftlet::ground {
namespace {

constexpr double kClearness = 0.8;  // of a response along its axis, cosine
constexpr const char* kNames[] = {"x", "y", "z"};
constexpr std::array<int, 3> kInOrder{0, 1, 2};

std::string describe_signs(const std::array<int, 3>& sign) {
  if (sign == std::array<int, 3>{-1, -1, -1}) return "all signs are reversed";
  if (sign == std::array<int, 3>{1, -1, -1})
    return "y and z are reversed: the axes are Forward-Left-Up (FLU) instead of Forward-Right-Down";
  std::string reversed;
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sign[i] > 0) continue;
    reversed += (count > 0 ? " and " : "") + std::string(kNames[i]);
    ++count;
  }
  return count == 1 ? "the sign of " + reversed + " is reversed"
                    : reversed + " are reversed: turned by 180 degrees";
}

// Two axes exchanged, without a change of sign.
std::string describe_exchange(const AxisMap& map) {
  if (map.sign != std::array<int, 3>{1, 1, 1}) return "";
  constexpr std::array<int, 2> kPairs[] = {{0, 1}, {1, 2}, {0, 2}};
  for (const auto& [a, b] : kPairs) {
    if (map.axis[static_cast<std::size_t>(a)] == b && map.axis[static_cast<std::size_t>(b)] == a)
      return fmt::format("{} and {} are exchanged", kNames[a], kNames[b]);
  }
  return "";
}

std::string describe_all(const AxisMap& map) {
  std::string text = "the axes are turned: ";
  for (std::size_t i = 0; i < 3; ++i) {
    text += fmt::format("{}{} shows {}{}", i > 0 ? ", " : "", kNames[i], map.sign[i] < 0 ? "-" : "",
                        kNames[static_cast<std::size_t>(map.axis[i])]);
  }
  return text;
}

}  // namespace

bool AxisMap::is_identity() const { return axis == kInOrder && sign == std::array<int, 3>{1, 1, 1}; }

Eigen::Matrix3d AxisMap::matrix() const {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) matrix(static_cast<Eigen::Index>(i), axis[i]) = sign[i];
  return matrix;
}

std::optional<AxisMap> axis_map(const Eigen::Matrix3d& response, double least) {
  AxisMap map;
  std::array<bool, 3> taken{};
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector3d column = response.col(j);
    Eigen::Index shown = 0;
    const double most = column.cwiseAbs().maxCoeff(&shown);
    if (!(column.norm() >= least) || most < kClearness * column.norm()) return std::nullopt;
    const auto i = static_cast<std::size_t>(shown);
    if (taken[i]) return std::nullopt;
    taken[i] = true;
    map.axis[i] = j;
    map.sign[i] = column(shown) > 0.0 ? 1 : -1;
  }
  return map;
}

std::string describe(const AxisMap& map) {
  if (map.is_identity()) return "";
  if (map.axis == kInOrder) return describe_signs(map.sign);
  const std::string exchange = describe_exchange(map);
  return exchange.empty() ? describe_all(map) : exchange;
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return math::kDegPerRad * std::atan2(a.cross(b).norm(), a.dot(b));
}

std::string to_string(const Eigen::Vector3d& vector, int decimals) {
  return fmt::format("({:.{}f}, {:.{}f}, {:.{}f})", vector.x(), decimals, vector.y(), decimals, vector.z(),
                     decimals);
}

}  // namespace swiftlet::ground
