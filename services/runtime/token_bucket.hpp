// A limit of a rate that allows bursts.
#pragma once

#include <algorithm>
#include <cstdint>

namespace swiftlet::runtime {

// Full at the start; some more tokens each second.
class TokenBucket {
 public:
  TokenBucket() = default;
  TokenBucket(double size, double per_second) : tokens_(size), size_(size), per_second_(per_second) {}

  // Returns false if it is empty. now_ns: of a monotonic clock.
  bool take(std::int64_t now_ns) {
    if (last_ns_ != 0)
      tokens_ = std::min(size_, tokens_ + static_cast<double>(now_ns - last_ns_) * 1e-9 * per_second_);
    last_ns_ = now_ns;
    if (tokens_ < 1.0) return false;
    tokens_ -= 1.0;
    return true;
  }
  // The rate of the tokens since the last take().
  void set(double size, double per_second) {
    size_ = size;
    per_second_ = per_second;
  }

 private:
  double tokens_ = 0.0;
  double size_ = 0.0;
  double per_second_ = 0.0;
  std::int64_t last_ns_ = 0;
};

}  // namespace swiftlet::runtime
