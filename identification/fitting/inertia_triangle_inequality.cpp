#include "swiftlet/identification/fitting/inertia_triangle_inequality.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kChanceDeviations = 4.0;  // largest correction, in standard deviations

}  // namespace

std::optional<std::string> enforce_triangle_inequality(
    Eigen::Matrix3d& inertia, const std::array<std::optional<double>, 3>& variances) {
  const auto identified = std::count_if(variances.begin(), variances.end(),
                                        [](const auto& variance) { return variance.has_value(); });
  if (identified == 0) return std::nullopt;
  const bool all = identified == 3;
  Eigen::Vector3d moments = inertia.diagonal();
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::optional<double>& variance = variances[static_cast<std::size_t>(i)];
    if (all) {
      weight[i] = *variance;
    } else if (!variance) {
      weight[i] = moments[i] * moments[i];
    }
  }
  Eigen::Index largest = 0;
  moments.maxCoeff(&largest);
  const double excess = 2.0 * moments[largest] - moments.sum();
  if (excess <= 0.0 || (all && excess > kChanceDeviations * std::sqrt(weight.sum()))) return std::nullopt;
  for (Eigen::Index i = 0; i < 3; ++i)
    moments[i] += (i == largest ? -1.0 : 1.0) * excess * weight[i] / weight.sum();
  inertia.diagonal() = moments;
  return std::string(plant::kInertiaKeys[static_cast<std::size_t>(largest)]) + " was estimated " +
         format_number(excess) + " kg*m^2 above the sum of the other moments, the limit for any body: " +
         (all ? "all three are corrected, within their uncertainty, to the nearest possible inertia"
              : "the moments that were not measured are corrected");
}

}  // namespace swiftlet::identification
