// The last few results of a computation that is asked for again and again, as by a fit whose steps move one
// parameter at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace swiftlet::identification {

// One thread at a time.
template <class Key, class Result>
class RecentResults {
 public:
  explicit RecentResults(std::size_t most) : most_(most) { kept_.reserve(most); }

  // What `compute` returned for an equal key, if that is still kept, or what it returns now.
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
