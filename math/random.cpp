#include "swiftlet/math/random.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::math {

namespace {

constexpr double kLog2 = 0.69314718055994531;

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

// Natural logarithm of a normal number x > 0: x = m 2^e with m near 1, log m = 2 atanh((m - 1)/(m + 1)) as a
// series. The last bit of std::log differs between processors.
double portable_log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < 0.70710678118654752) {
    mantissa *= 2.0;
    --exponent;
  }
  constexpr std::array<double, 11> kSeries = {1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11,
                                              1.0 / 9,  1.0 / 7,  1.0 / 5,  1.0 / 3,  1.0};
  const double s = (mantissa - 1.0) / (mantissa + 1.0);
  const double s2 = s * s;
  double sum = 0.0;
  for (const double coefficient : kSeries) sum = sum * s2 + coefficient;
  return 2.0 * s * sum + exponent * kLog2;
}

// e^x of a finite x: 2^k e^r with |r| <= log(2)/2, e^r as a series.
double portable_exp(double x) {
  const double k = std::floor(x / kLog2 + 0.5);
  const double r = x - k * kLog2;
  double sum = 1.0;
  for (int i = 16; i > 0; --i) sum = 1.0 + sum * r / i;
  return std::ldexp(sum, static_cast<int>(k));
}

// For 256 layers: the start of the tail, the height of the curve there, and the area of each layer, which is
// kTail * kTailHeight plus the area of the tail.
constexpr double kTail = 3.6541528853610088;
constexpr double kTailHeight = 1.2602859304985976e-3;
constexpr double kLayerArea = 4.9286732339746547e-3;

Ziggurat make_ziggurat() {
  Ziggurat out;
  out.edge[0] = kLayerArea / kTailHeight;
  out.edge[1] = kTail;
  out.height[1] = kTailHeight;
  for (std::size_t i = 2; i < Ziggurat::kLayers; ++i) {
    out.height[i] = out.height[i - 1] + kLayerArea / out.edge[i - 1];
    out.edge[i] = std::sqrt(-2.0 * portable_log(out.height[i]));
  }
  out.height[Ziggurat::kLayers] = 1.0;
  return out;
}

}  // namespace

const Ziggurat kZiggurat = make_ziggurat();

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream_id) {
  std::uint64_t mix = seed;
  mix = splitmix64(mix) ^ stream_id;
  for (std::uint64_t& word : state_) word = splitmix64(mix);
}

// Completes a draw that lies in the part of its layer that the curve crosses (the wedge), or in the tail.
double RandomStream::normal_in_wedge(std::size_t layer, double x) {
  if (layer == 0) return x < 0.0 ? -normal_tail() : normal_tail();
  const double bottom = kZiggurat.height[layer];
  const double height = bottom + uniform() * (kZiggurat.height[layer + 1] - bottom);
  return -2.0 * portable_log(height) > x * x ? x : normal();
}

double RandomStream::uniform(double min, double max) {
  return std::clamp(min + (max - min) * uniform(), min, max);
}

double RandomStream::log_uniform(double min, double max) {
  const double log_min = portable_log(min);
  return std::clamp(portable_exp(log_min + (portable_log(max) - log_min) * uniform()), min, max);
}

double RandomStream::truncated_normal(double mean, double sigma, double min, double max) {
  for (;;) {
    const double value = mean + sigma * normal();
    if (value >= min && value <= max) return value;
  }
}

// Normal deviate above kTail (Marsaglia 1964).
double RandomStream::normal_tail() {
  for (;;) {
    const double beyond = -portable_log(1.0 - uniform()) / kTail;
    const double depth = -portable_log(1.0 - uniform());
    if (2.0 * depth > beyond * beyond) return kTail + beyond;
  }
}

Eigen::Vector3d RandomStream::in_unit_ball() {
  for (;;) {
    const double x = 2.0 * uniform() - 1.0;
    const double y = 2.0 * uniform() - 1.0;
    const double z = 2.0 * uniform() - 1.0;
    if (x * x + y * y + z * z <= 1.0) return {x, y, z};
  }
}

Eigen::Vector3d RandomStream::on_unit_sphere() {
  for (;;) {
    const Eigen::Vector3d point = in_unit_ball();
    const double square = point.x() * point.x() + point.y() * point.y() + point.z() * point.z();
    if (square > 0.01) return point / std::sqrt(square);
  }
}

}  // namespace swiftlet::math
