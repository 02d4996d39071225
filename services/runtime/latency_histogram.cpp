#include "swiftlet/services/runtime/latency_histogram.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::runtime {

// Below 2^kSubBits a bucket is 1 ns wide. Octave e = 1, 2, .. holds values whose highest bit is kSubBits - 1
// + e, in buckets of 2^(e-1) ns.
int LatencyHistogram::bucket_of(std::uint64_t nanoseconds) noexcept {
  constexpr std::uint64_t kSub = 1U << kSubBits;
  const std::uint64_t value = std::min(nanoseconds, (std::uint64_t{1} << kMaxBits) - 1);
  if (value < kSub) return static_cast<int>(value);
  const int octave = 64 - __builtin_clzll(value) - kSubBits;
  const std::uint64_t within = (value >> (octave - 1)) - kSub;
  return static_cast<int>((static_cast<std::uint64_t>(octave) << kSubBits) + within);
}

std::int64_t LatencyHistogram::upper_end_of(int bucket) noexcept {
  constexpr int kSub = 1 << kSubBits;
  if (bucket < kSub) return bucket;
  const int octave = bucket >> kSubBits;
  const std::int64_t within = bucket & (kSub - 1);
  return ((kSub + within + 1) << (octave - 1)) - 1;
}

void LatencyHistogram::record(std::int64_t nanoseconds) noexcept {
  const std::int64_t value = std::max<std::int64_t>(nanoseconds, 0);
  ++counts_[static_cast<std::size_t>(bucket_of(static_cast<std::uint64_t>(value)))];
  ++count_;
  max_ns_ = std::max(max_ns_, value);
}

void LatencyHistogram::reset() noexcept { *this = {}; }

std::int64_t LatencyHistogram::quantile_ns(double q) const noexcept {
  if (count_ == 0) return 0;
  const double share = std::ceil(std::clamp(q, 0.0, 1.0) * static_cast<double>(count_));
  const auto rank = std::max<std::uint64_t>(static_cast<std::uint64_t>(share), 1);
  std::uint64_t seen = 0;
  for (int bucket = 0; bucket < kBuckets; ++bucket) {
    seen += counts_[static_cast<std::size_t>(bucket)];
    if (seen >= rank) return std::min(upper_end_of(bucket), max_ns_);
  }
  return max_ns_;
}

}  // namespace swiftlet::runtime
