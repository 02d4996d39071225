#include "swiftlet/identification/flight/command_fit.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Adds the information of a fit to that of all parameters, for those of the same name.
void add_information(const CommandFit& from, const CommandModel& to, MatrixXd& information,
                     VectorXd& weighted) {
  const std::vector<FlightParameter>& theirs = from.model->layout().parameters;
  const std::vector<FlightParameter>& ours = to.layout().parameters;
  const MatrixXd own = from.fit.covariance.ldlt().solve(MatrixXd::Identity(from.x().size(), from.x().size()));
  MatrixXd names = MatrixXd::Zero(static_cast<Index>(theirs.size()), static_cast<Index>(ours.size()));
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    for (std::size_t j = 0; j < ours.size(); ++j) {
      if (theirs[i].name == ours[j].name) names(static_cast<Index>(i), static_cast<Index>(j)) = 1.0;
    }
  }
  information += names.transpose() * own * names;
  weighted += names.transpose() * own * from.x();
}

}  // namespace

CommandFit fit_responses(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                         std::vector<Response> responses, std::optional<KnownThrust> known,
                         const std::vector<const CommandFit*>& before,
                         const std::function<void()>& progress) {
  CommandFit out;
  out.model = std::make_unique<CommandModel>(flights, base, std::move(responses), std::move(known));
  SeriesProblem problem = out.model->problem(progress);
  for (const CommandFit* const fit : before)
    problem.start = started_from(*fit->model, fit->x(), *out.model, problem.start);
  out.fit = fit_series(problem);
  return out;
}

KnownThrust thrust_of(const CommandFit& fit) {
  KnownThrust out{fit.model->curve(fit.x()), {}};
  for (std::size_t flight = 0; flight < fit.model->flights().size(); ++flight)
    out.drift.push_back(fit.model->drift(fit.x(), flight));
  return out;
}

std::vector<CommandFit> fit_alone(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                                  const std::function<void()>& progress) {
  std::vector<CommandFit> out;
  out.push_back(fit_responses(flights, base, {Response::kForce}, std::nullopt, {}, progress));
  const KnownThrust thrust = thrust_of(out[0]);
  for (const Response response : {Response::kRoll, Response::kPitch})
    out.push_back(fit_responses(flights, base, {response}, thrust, {}, progress));
  return out;
}

CommandFit combined_fit(const std::vector<FlightSeries>& flights, const plant::Vehicle& base,
                        const CommandFit& force, const CommandFit& moments) {
  CommandFit out;
  out.model = std::make_unique<CommandModel>(
      flights, base, std::vector<Response>{kAllResponses.begin(), kAllResponses.end()}, std::nullopt);
  const CommandLayout& l = out.model->layout();
  const auto count = static_cast<Index>(l.parameters.size());
  MatrixXd information = MatrixXd::Zero(count, count);
  VectorXd weighted = VectorXd::Zero(count);
  add_information(force, *out.model, information, weighted);
  add_information(moments, *out.model, information, weighted);
  // Scaled: the parameters have units of very different sizes.
  const VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
  out.fit.covariance =
      scale.asDiagonal() * solver.solve(MatrixXd::Identity(count, count)) * scale.asDiagonal();
  out.fit.parameters = out.fit.covariance * weighted;
  // The noise stays as it was fitted: a step along its covariance can leave the range in which its filter is stable.
  const auto noise = count - static_cast<Index>(out.model->physical_parameters().size());
  out.fit.parameters.tail(noise) =
      started_from(*force.model, force.x(), *out.model,
                   started_from(*moments.model, moments.x(), *out.model, out.fit.parameters))
          .tail(noise);
  const double slope = out.fit.parameters[l.curve + 1];
  const ThrustCurve of_moments = force.model->curve(force.x());
  MatrixXd follows = MatrixXd::Identity(count, count);
  for (int axis = 0; axis < 3; ++axis) {
    out.fit.parameters[l.gain[axis]] *= of_moments.slope / slope;
    out.fit.parameters[l.trim[axis]] *= of_moments.value / out.fit.parameters[l.curve];
    follows(l.gain[axis], l.curve + 1) = -out.fit.parameters[l.gain[axis]] / slope;
    follows(l.trim[axis], l.curve) = -out.fit.parameters[l.trim[axis]] / plant::kGravity;
  }
  out.fit.covariance = (follows * out.fit.covariance * follows.transpose()).eval();
  out.fit.degrees_of_freedom = std::min(force.fit.degrees_of_freedom, moments.fit.degrees_of_freedom);
  out.fit.converged = force.fit.converged && moments.fit.converged;
  return out;
}

}  // namespace swiftlet::identification
