#include "swiftlet/identification/fitting/inertia_triangle_inequality.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kChanceDeviations = 4.0;

}  // namespace

std::optional<std::string> enforce_triangle_inequality(
    Eigen::Matrix3d& inertia, const std::array<std::optional<double>, 3>& variances) {
  const auto identified = std::count_if(variances.begin(), variances.end(),
                                        [](const auto& variance) { return variance.has_value(); });
  if (identified == 0) return std::nullopt;
  const bool all = identified == 3;
  Eigen::Vector3d moments = inertia.diagonal();
  Eigen::Vector3d give = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::optional<double>& variance = variances[static_cast<std::size_t>(i)];
    if (all) {
      give[i] = *variance;
    } else if (!variance) {
      give[i] = moments[i] * moments[i];
    }
  }
  Eigen::Index largest = 0;
  moments.maxCoeff(&largest);
  const double beyond = 2.0 * moments[largest] - moments.sum();
  if (beyond <= 0.0 || (all && beyond > kChanceDeviations * std::sqrt(give.sum()))) return std::nullopt;
  for (Eigen::Index i = 0; i < 3; ++i)
    moments[i] += (i == largest ? -1.0 : 1.0) * beyond * give[i] / give.sum();
  inertia.diagonal() = moments;
  return std::string(plant::kInertiaKeys[static_cast<std::size_t>(largest)]) + " came out " +
         format_number(beyond) + " kg*m^2 above the sum of the other moments, which no body exceeds: " +
         (all ? "the nearest that is possible, within what chance gives, is taken"
              : "those that were not measured are moved");
}

}  // namespace swiftlet::identification
