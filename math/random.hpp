// Random numbers that are the same on every machine and with every standard library: xoshiro256++ (Blackman,
// Vigna 2019) seeded by splitmix64, normal deviates by the ziggurat (Marsaglia, Tsang 2000; Doornik 2005),
// logarithm and exponential made of additions, multiplications and divisions only.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace swiftlet::plant {

// The area under exp(-x^2 / 2), x > 0, in layers of equal area: layer i is the rectangle of width edge[i]
// between height[i] and height[i + 1]. Layer 0 is the part below height[1] with its unending tail, as wide as
// if it were a rectangle.
struct Ziggurat {
  static constexpr std::size_t kLayers = 256;
  std::array<double, kLayers + 1> edge{};    // falling, edge[1] is where the tail begins
  std::array<double, kLayers + 1> height{};  // exp(-edge^2 / 2), but for layer 0
};
extern const Ziggurat kZiggurat;

// Streams of one seed and different ids are independent of each other: what one draws does not move another.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream_id);

  std::uint64_t next();
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }  // [0, 1)
  double uniform(double min, double max);                                      // [min, max]
  double log_uniform(double min, double max);  // of uniform logarithm; 0 < min <= max
  double normal();                             // mean 0, standard deviation 1
  // A normal deviate that lies within min .. max: those outside are drawn again, so the mean must lie within
  // and the limits be at least a sigma apart.
  double truncated_normal(double mean, double sigma, double min, double max);
  Eigen::Vector3d normal3();         // three of them
  Eigen::Vector3d in_unit_ball();    // uniform in volume
  Eigen::Vector3d on_unit_sphere();  // uniform in area

 private:
  double normal_beside(std::size_t layer, double x);
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
  // 54 bits for the place, 8 others for the layer.
  const std::uint64_t bits = next();
  const std::size_t layer = bits % Ziggurat::kLayers;
  const double place = static_cast<double>(bits >> 10U) * 0x1.0p-53 - 1.0;  // [-1, 1)
  const double x = place * kZiggurat.edge[layer];
  if (std::abs(x) < kZiggurat.edge[layer + 1]) return x;  // 98.5 %: below the curve, whatever its height
  return normal_beside(layer, x);
}

inline Eigen::Vector3d RandomStream::normal3() {
  const double x = normal();
  const double y = normal();
  const double z = normal();
  return {x, y, z};
}

}  // namespace swiftlet::plant
