// Helpers of the conversions: vectors and quaternions, and the validation of received messages.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::messages::wire {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kQuaternionTolerance = 1e-3;  // of the norm
constexpr double kRounding = 1e-12;

using Vector3 = std::array<double, 3>;
using Vector4 = std::array<double, 4>;
using PerRotor = std::array<double, plant::kMaxRotors>;

inline Vector3d vector(const Vector3& in) { return {in[0], in[1], in[2]}; }
inline Vector3 array(const Vector3d& in) { return {in.x(), in.y(), in.z()}; }
// A quaternion whose norm differs from 1 by rounding only is not normalized, so that a sample is received bit
// for bit as it was sent.
inline Quaterniond quaternion(const Vector4& in) {
  const Quaterniond q(in[0], in[1], in[2], in[3]);
  return std::abs(q.squaredNorm() - 1.0) < kRounding ? q : q.normalized();
}
inline Vector4 array(const Quaterniond& in) { return {in.w(), in.x(), in.y(), in.z()}; }

// Records the first fault of a message and skips the later checks.
class Check {
 public:
  // The following checks apply to the item with this number, counted from 1.
  void of_item(const char* item, std::size_t number) {
    item_ = item;
    number_ = number;
  }
  void of_message() { number_ = 0; }

  Check& finite(const char* field, double value) {
    if (ok() && !std::isfinite(value)) fail("%s is %g, must be finite", field, value);
    return *this;
  }
  template <class Number, std::size_t kSize>
  Check& finite(const char* field, const std::array<Number, kSize>& values) {
    for (std::size_t i = 0; ok() && i < kSize; ++i) {
      if (!std::isfinite(values[i])) fail("%s[%zu] is %g, must be finite", field, i, double{values[i]});
    }
    return *this;
  }
  Check& within(const char* field, double value, double min, double max) {
    if (ok() && !(value >= min && value <= max))
      fail("%s is %g, must be between %g and %g", field, value, min, max);
    return *this;
  }
  Check& at_least(const char* field, double value, double min) {
    finite(field, value);
    if (ok() && value < min) fail("%s is %g, must be at least %g", field, value, min);
    return *this;
  }
  Check& at_most(const char* field, std::uint64_t value, std::uint64_t max) {
    if (ok() && value > max) {
      fail("%s is %llu, must be at most %llu", field, static_cast<unsigned long long>(value),
           static_cast<unsigned long long>(max));
    }
    return *this;
  }
  Check& unit(const char* field, const Vector4& q) {
    finite(field, q);
    const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (ok() && std::abs(norm - 1.0) > kQuaternionTolerance) {
      fail("%s has the length %g, must be 1 within %g", field, norm, kQuaternionTolerance);
    }
    return *this;
  }
  Check& time(std::int64_t stamp_ns) {
    if (ok() && stamp_ns < 0) fail("stamp_ns is %lld, must be at least 0", static_cast<long long>(stamp_ns));
    return *this;
  }
  // Checks that the first `count` values are within the bounds, and that count is at most kMaxRotors.
  Check& per_rotor(const char* field, int count, const PerRotor& values, double min, double max) {
    at_most("rotor_count", static_cast<std::uint64_t>(count), plant::kMaxRotors);
    for (std::size_t i = 0; ok() && i < static_cast<std::size_t>(count); ++i) {
      if (!(values[i] >= min && values[i] <= max)) {
        fail("%s[%zu] is %g, must be between %g and %g", field, i, values[i], min, max);
      }
    }
    return *this;
  }

  bool ok() const { return !fault_; }
  Fault fault() const { return fault_; }

 private:
  [[gnu::format(printf, 2, 3)]] void fail(const char* format, ...) {
    int length = 0;
    if (number_ > 0) length = std::snprintf(fault_.text, sizeof fault_.text, "%s %zu: ", item_, number_);
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(fault_.text + length, sizeof fault_.text - static_cast<std::size_t>(length), format,
                   values);
    va_end(values);
  }

  const char* item_ = "";
  std::size_t number_ = 0;  // 0: checks apply to the message itself
  Fault fault_;
};

inline void copy_rotors(int count, const PerRotor& from, PerRotor& to) {
  to = {};
  std::copy_n(from.begin(), count, to.begin());
}

}  // namespace swiftlet::messages::wire
