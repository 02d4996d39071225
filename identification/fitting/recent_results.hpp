// Cache of the most recent results of a computation, for a fit that changes one parameter at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace swiftlet::identification {

// Not thread-safe.
template <class Key, class Result>
class RecentResults {
 public:
  explicit RecentResults(std::size_t most) : most_(most) { kept_.reserve(most); }

  // Returns the cached result for an equal key, or calls `compute` and caches its result. When the cache is
  // full, the oldest result is replaced.
  template <class Compute>
  std::shared_ptr<const Result> of(const Key& key, const Compute& compute) {
    for (const auto& [kept, result] : kept_) {
      if (kept == key) return result;
    }
    auto made = std::make_shared<const Result>(compute());
    if (kept_.size() < most_) {
      kept_.emplace_back(key, made);
    } else {
      kept_[oldest_] = {key, made};
      oldest_ = (oldest_ + 1) % most_;
    }
    return made;
  }

 private:
  std::size_t most_;
  std::size_t oldest_ = 0;
  std::vector<std::pair<Key, std::shared_ptr<const Result>>> kept_;
};

}  // namespace swiftlet::identification
