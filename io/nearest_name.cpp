#include "swiftlet/io/nearest_name.hpp"

#include <algorithm>
#include <cstddef>

namespace swiftlet::io {
namespace {

constexpr std::size_t kLongestName = 100;

// Edit distance: the number of inserted, deleted or replaced characters (Levenshtein 1966).
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearest_name(const std::vector<std::string>& names, const std::string& wanted) {
  if (names.empty() || wanted.size() > kLongestName) return "";
  const auto letters = [&](const std::string& name) {
    const bool begins_alike = wanted.size() >= 3 && name.compare(0, wanted.size(), wanted) == 0;
    return begins_alike ? 0 : distance(name, wanted);
  };
  const auto nearest = std::min_element(
      names.begin(), names.end(), [&](const auto& a, const auto& b) { return letters(a) < letters(b); });
  const std::size_t longer = std::max(nearest->size(), wanted.size());
  const std::size_t differ = letters(*nearest);
  return 3 * differ <= longer || (differ <= 2 && longer > 3) ? *nearest : "";
}

std::string did_you_mean(const std::vector<std::string>& names, const std::string& wanted) {
  const std::string nearest = nearest_name(names, wanted);
  return nearest.empty() ? "" : " Did you mean '" + nearest + "'?";
}

std::string or_nearest(const std::vector<std::string>& names, const std::string& wanted) {
  const std::string nearest = nearest_name(names, wanted);
  return nearest.empty() ? "" : "; nearest is " + nearest;
}

}  // namespace swiftlet::io
