// Fits of a CommandModel to flights: each response alone, the moments, and all of them as one.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "swiftlet/identification/flight/command_model.hpp"

namespace swiftlet::identification {

struct CommandFit {
  std::unique_ptr<CommandModel> model;
  SeriesFit fit;

  const Eigen::VectorXd& x() const { return fit.parameters; }
};

// before: fits of which this one takes the start of the parameters that they have in common.
CommandFit fit_responses(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                         std::vector<Response> responses, std::optional<KnownThrust> known,
                         const std::vector<const CommandFit*>& before, const std::function<void()>& progress);

KnownThrust thrust_of(const CommandFit& fit);

// Fits specific force, roll and pitch alone. Yaw does not determine the lag: the rotors' own inertia has a
// similar effect there.
std::vector<CommandFit> fit_alone(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                                  const std::function<void()>& progress);

// The fits of force and of moments as one of all responses: the lag, which both have, is their weighted mean, and what is
// correlated with it follows. The thrust over the command is that of the force alone: in the moments, feedback and effects
// that the model omits would pass for a slope of it. The gains are inverse to the slope: they follow where the common lag moves
// it, and its uncertainty is added to theirs.
CommandFit combined_fit(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                        const CommandFit& force, const CommandFit& moments);

}  // namespace swiftlet::identification
