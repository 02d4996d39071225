// A histogram of durations with buckets of fixed relative width: resolution 1/32, range 1 ns to 69 s. No
// heap.
#pragma once

#include <array>
#include <cstdint>

namespace swiftlet::runtime {

// Log-linear buckets as in HdrHistogram (Tene 2012): every power of two is divided into 32 equal buckets. Not
// thread-safe.
class LatencyHistogram {
 public:
  // A negative duration counts as 0. In the quantiles a duration beyond the range counts as the end of the
  // range; max_ns() is exact.
  void record(std::int64_t nanoseconds) noexcept;
  void reset() noexcept;

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_ns_; }

  // Returns the q-quantile (q in 0 .. 1) of the recorded durations: the upper end of its bucket, at most
  // max_ns(). 0 if none was recorded.
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
