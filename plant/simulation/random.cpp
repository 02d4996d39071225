#include "plant/simulation/random.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::plant {

namespace {

constexpr double kLog2 = 0.69314718055994531;

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

std::uint64_t rotate_left(std::uint64_t x, unsigned count) { return (x << count) | (x >> (64U - count)); }

// Natural logarithm of x > 0, normal: x = m 2^e with m around 1, log m = 2 atanh((m - 1)/(m + 1)) as a
// series. The C library's differs in the last bit from processor to processor.
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

// e^x of a finite x: 2^k e^r with r within +-log(2)/2, e^r as a series.
double portable_exp(double x) {
  const double k = std::floor(x / kLog2 + 0.5);
  const double r = x - k * kLog2;
  double sum = 1.0;
  for (int i = 16; i > 0; --i) sum = 1.0 + sum * r / i;
  return std::ldexp(sum, static_cast<int>(k));
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream_id) {
  std::uint64_t mix = seed;
  mix = splitmix64(mix) ^ stream_id;
  for (std::uint64_t& word : state_) word = splitmix64(mix);
}

std::uint64_t RandomStream::next() {
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

double RandomStream::uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }

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

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  for (;;) {
    const double u = 2.0 * uniform() - 1.0;
    const double v = 2.0 * uniform() - 1.0;
    const double s = u * u + v * v;
    if (s >= 1.0 || s == 0.0) continue;
    const double scale = std::sqrt(-2.0 * portable_log(s) / s);
    spare_ = v * scale;
    has_spare_ = true;
    return u * scale;
  }
}

Eigen::Vector3d RandomStream::normal3() {
  const double x = normal();
  const double y = normal();
  const double z = normal();
  return {x, y, z};
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

}  // namespace swiftlet::plant
