#include "swiftlet/identification/fitting/flight_parameter.hpp"

#include <utility>

namespace swiftlet::identification {

int add(FlightParameter parameter, std::vector<FlightParameter>& parameters) {
  parameters.push_back(std::move(parameter));
  return static_cast<int>(parameters.size()) - 1;
}

SeriesProblem problem_of(const std::vector<FlightParameter>& parameters) {
  SeriesProblem out;
  const auto count = static_cast<Eigen::Index>(parameters.size());
  out.start.resize(count);
  out.scale.resize(count);
  out.low.resize(count);
  out.high.resize(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const FlightParameter& parameter = parameters[static_cast<std::size_t>(i)];
    out.start[i] = parameter.start;
    out.scale[i] = parameter.scale;
    out.low[i] = parameter.low;
    out.high[i] = parameter.high;
  }
  return out;
}

}  // namespace swiftlet::identification
