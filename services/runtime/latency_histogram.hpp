// Durations counted in buckets of a fixed relative width: exact to 1 part in 32, from 1 ns to a minute,
// without heap.
#pragma once

#include <array>
#include <cstdint>

namespace swiftlet::runtime {

// Log-linear, as HdrHistogram (Tene 2012): every power of two is cut into 32 equal buckets. Not for use by
// several threads.
class LatencyHistogram {
 public:
  // A negative duration counts as 0, one beyond the range as the range's end in the quantiles; max is kept as
  // given.
  void record(std::int64_t nanoseconds) noexcept;
  void reset() noexcept;

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_ns_; }

  // The duration that a share q (0 .. 1) of those recorded do not exceed: the upper end of its bucket, at
  // most max_ns(). 0 if none was recorded.
  std::int64_t quantile_ns(double q) const noexcept;

 private:
  static constexpr int kSubBits = 5;
  static constexpr int kMaxBits = 36;  // 2^36 ns are 69 s
  static constexpr int kBuckets = (kMaxBits - kSubBits + 1) << kSubBits;

  static int bucket_of(std::uint64_t nanoseconds) noexcept;
  static std::int64_t upper_end_of(int bucket) noexcept;

  std::array<std::uint32_t, kBuckets> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace swiftlet::runtime
