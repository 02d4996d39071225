// Random numbers that are identical on every machine and with every standard library: xoshiro256++ (Blackman,
// Vigna 2019) seeded by splitmix64. Normal deviates use the ziggurat method (Marsaglia, Tsang 2000; Doornik
// 2005). Logarithm and exponential use additions, multiplications and divisions only.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace swiftlet::math {

// Table of the ziggurat method: the area under exp(-x^2 / 2), x > 0, in layers of equal area. Layer i is the
// rectangle of width edge[i] between height[i] and height[i + 1]. Layer 0 is the area below height[1]
// including the infinite tail; edge[0] is the width of a rectangle of the same area.
struct Ziggurat {
  static constexpr std::size_t kLayers = 256;
  std::array<double, kLayers + 1> edge{};    // descending; the tail begins at edge[1]
  std::array<double, kLayers + 1> height{};  // exp(-edge^2 / 2), except for layer 0
};
extern const Ziggurat kZiggurat;

// Stream of random numbers. Streams with the same seed and different ids are independent: draws from one do
// not affect another.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream_id);

  std::uint64_t next();
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }  // [0, 1)
  double uniform(double min, double max);                                      // [min, max]
  double log_uniform(double min, double max);  // uniform in the logarithm; 0 < min <= max
  double normal();                             // mean 0, standard deviation 1
  // Normal deviate truncated to min .. max. Values outside are drawn again; the mean must therefore lie
  // within the limits and the limits must be at least one sigma apart.
  double truncated_normal(double mean, double sigma, double min, double max);
  Eigen::Vector3d normal3();         // three calls of normal()
  Eigen::Vector3d in_unit_ball();    // uniform in volume
  Eigen::Vector3d on_unit_sphere();  // uniform in area

 private:
  double normal_in_wedge(std::size_t layer, double x);
  double normal_tail();

  std::array<std::uint64_t, 4> state_;
};

inline std::uint64_t RandomStream::next() {
  const auto rotate_left = [](std::uint64_t x, unsigned count) {
    return (x << count) | (x >> (64U - count));
  };
  const std::uint64_t result = rotate_left(state_[0] + state_[3], 23U) + state_[0];
  const std::uint64_t t = state_[1] << 17U;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = rotate_left(state_[3], 45U);
  return result;
}

inline double RandomStream::normal() {
  // 54 bits for the place, 8 other bits for the layer.
  const std::uint64_t bits = next();
  const std::size_t layer = bits % Ziggurat::kLayers;
  const double place = static_cast<double>(bits >> 10U) * 0x1.0p-53 - 1.0;  // [-1, 1)
  const double x = place * kZiggurat.edge[layer];
  if (std::abs(x) < kZiggurat.edge[layer + 1]) return x;  // 98.5 % of draws: below the curve at any height
  return normal_in_wedge(layer, x);
}

inline Eigen::Vector3d RandomStream::normal3() {
  const double x = normal();
  const double y = normal();
  const double z = normal();
  return {x, y, z};
}

}  // namespace swiftlet::math
