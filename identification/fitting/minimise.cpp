#include "swiftlet/identification/fitting/minimise.hpp"

namespace swiftlet::identification {
namespace {

class CallOnIteration final : public ceres::IterationCallback {
 public:
  explicit CallOnIteration(const std::function<void()>& call) : call_(call) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    if (call_) call_();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  const std::function<void()>& call_;
};

}  // namespace

bool minimise(ceres::CostFunction& cost, const Minimisation& settings,
              const std::function<void()>& on_iteration, Eigen::VectorXd& x) {
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, x.data());
  for (Eigen::Index i = 0; i < settings.low.size(); ++i) {
    problem.SetParameterLowerBound(x.data(), static_cast<int>(i), settings.low[i]);
    problem.SetParameterUpperBound(x.data(), static_cast<int>(i), settings.high[i]);
  }
  CallOnIteration callback(on_iteration);
  ceres::Solver::Options options;
  options.linear_solver_type = settings.linear_solver;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = settings.most_iterations;
  options.function_tolerance = settings.function_tolerance;
  options.parameter_tolerance = settings.parameter_tolerance;
  options.gradient_tolerance = settings.gradient_tolerance;
  // With bounds, Ceres runs a line search on every step, which usually evaluates only its end point. The
  // default, cubic interpolation, needs the Jacobian there: two of three Jacobians of a fit, which take most
  // of its time.
  options.line_search_interpolation_type = ceres::QUADRATIC;
  options.callbacks.push_back(&callback);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE && x.allFinite();
}

}  // namespace swiftlet::identification
