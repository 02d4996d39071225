#include "swiftlet/io/settings/violations.hpp"

namespace swiftlet::io {

void reject_violations(const ConfigNode& root, const std::vector<plant::Violation>& violations) {
  if (violations.empty()) return;
  const plant::Violation& first = violations.front();
  throw ConfigError(root.file(), root.nearest(first.key).line(), first.key, first.message);
}

}  // namespace swiftlet::io
