// ARMA noise, v = C(q) / D(q) e with white innovations e (Box, Jenkins 1970). Both polynomials are monic, of
// order kNoiseOrder, with all roots inside the unit circle. A fit that minimises the innovations rather than
// the noise itself is consistent under feedback (Ljung 1999, chapter 13): the feedback reacts to past
// disturbances and is uncorrelated with the next innovation.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace swiftlet::identification {

constexpr std::size_t kNoiseOrder = 2;

struct ArmaNoise {
  std::array<double, kNoiseOrder> numerator{};    // C(q) = 1 + numerator[0] q^-1 + numerator[1] q^-2
  std::array<double, kNoiseOrder> denominator{};  // D(q), in the same form
};

// Polynomials from reflection coefficients: two for C, then two for D. Coefficients between -1 and 1 give
// exactly the stable polynomials.
constexpr std::size_t kNoiseParameters = 2 * kNoiseOrder;
ArmaNoise arma_noise(const double* reflection);

// Innovations of a series, one per sample. Series and innovations before the first sample are taken as 0.
std::vector<double> innovations(const ArmaNoise& noise, const std::vector<double>& series);

// Predicts the noise over `ahead` samples after the first `known` samples of a series.
std::vector<double> expected_noise(const ArmaNoise& noise, const std::vector<double>& series,
                                   const std::vector<double>& innovations, std::size_t known,
                                   std::size_t ahead);

}  // namespace swiftlet::identification
