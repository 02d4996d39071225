// Noise in time whose samples hang together: white innovations e behind a filter, v = C(q) / D(q) e (Box,
// Jenkins 1970), both polynomials monic, of order kNoiseOrder, with all roots inside the unit circle. A fit
// that makes the innovations small, not the noise itself, stays right under feedback (Ljung 1999, chapter
// 13): what feedback does follows the disturbance and cannot foretell its next innovation.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace swiftlet::identification {

constexpr std::size_t kNoiseOrder = 2;

struct ArmaNoise {
  std::array<double, kNoiseOrder> numerator{};    // C(q) = 1 + numerator[0] q^-1 + numerator[1] q^-2
  std::array<double, kNoiseOrder> denominator{};  // D(q), likewise
};

// From two reflection coefficients for C, then two for D; each between -1 and 1, which holds for exactly the
// polynomials that are stable.
constexpr std::size_t kNoiseParameters = 2 * kNoiseOrder;
ArmaNoise arma_noise(const double* reflection);

// The innovations of a series, as long as it; before it, all is taken to be 0.
std::vector<double> innovations(const ArmaNoise& noise, const std::vector<double>& series);

// What is to be expected of the noise after the first `known` samples of a series, `ahead` samples of it.
std::vector<double> expected_noise(const ArmaNoise& noise, const std::vector<double>& series,
                                   const std::vector<double>& innovations, std::size_t known,
                                   std::size_t ahead);

}  // namespace swiftlet::identification
