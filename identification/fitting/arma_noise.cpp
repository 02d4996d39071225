#include "swiftlet/identification/fitting/arma_noise.hpp"

namespace swiftlet::identification {
namespace {

// The step-up recursion of Levinson and Durbin.
std::array<double, kNoiseOrder> stable_polynomial(const double* reflection) {
  return {reflection[0] * (1.0 + reflection[1]), reflection[1]};
}

double before(const std::vector<double>& series, std::size_t now, std::size_t lag) {
  return lag <= now ? series[now - lag] : 0.0;
}

}  // namespace

ArmaNoise arma_noise(const double* reflection) {
  return {stable_polynomial(reflection), stable_polynomial(reflection + kNoiseOrder)};
}

std::vector<double> innovations(const ArmaNoise& noise, const std::vector<double>& series) {
  std::vector<double> out(series.size());
  for (std::size_t k = 0; k < series.size(); ++k) {
    double value = series[k];
    for (std::size_t i = 0; i < kNoiseOrder; ++i)
      value += noise.denominator[i] * before(series, k, i + 1) - noise.numerator[i] * before(out, k, i + 1);
    out[k] = value;
  }
  return out;
}

std::vector<double> expected_noise(const ArmaNoise& noise, const std::vector<double>& series,
                                   const std::vector<double>& innovations, std::size_t known,
                                   std::size_t ahead) {
  std::array<double, kNoiseOrder> past{};              // last values of the series, newest first
  std::array<double, kNoiseOrder> past_innovations{};  // newest first
  for (std::size_t i = 0; i < kNoiseOrder; ++i) {
    past[i] = before(series, known, i + 1);
    past_innovations[i] = before(innovations, known, i + 1);
  }
  std::vector<double> out(ahead);
  for (double& value : out) {
    for (std::size_t i = 0; i < kNoiseOrder; ++i)
      value += noise.numerator[i] * past_innovations[i] - noise.denominator[i] * past[i];
    for (std::size_t i = kNoiseOrder - 1; i > 0; --i) {
      past[i] = past[i - 1];
      past_innovations[i] = past_innovations[i - 1];
    }
    past[0] = value;
    past_innovations[0] = 0.0;
  }
  return out;
}

}  // namespace swiftlet::identification
