#include "swiftlet/services/dds/limited_log.hpp"

#include <iterator>

#include "swiftlet/services/runtime/log.hpp"

namespace swiftlet::dds {

void LimitedLog::warn(const std::string& line, Time now) {
  for (auto it = written_.begin(); it != written_.end();)
    it = now - it->second >= kPeriod ? written_.erase(it) : std::next(it);
  if (written_.size() >= kMostLines || !written_.emplace(line, now).second) return;
  runtime::log_warning("{}", line);
}

}  // namespace swiftlet::dds
