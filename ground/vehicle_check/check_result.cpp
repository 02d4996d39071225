#include "swiftlet/ground/vehicle_check/check_result.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/core.h>

namespace swiftlet::ground {

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "pass";
    case Verdict::kFail:
      return "FAIL";
    case Verdict::kSkipped:
      return "skipped";
  }
  return "";
}

Figure figure(double value, const std::string& unit, int decimals, const std::string& more) {
  return {value, unit, fmt::format("{:.{}f}{}{}{}", value, decimals, unit.empty() ? "" : " ", unit, more)};
}

CheckResult judged(const std::string& name, Figure figure, const std::string& limit,
                   const std::string& finding) {
  return {name, finding.empty() ? Verdict::kPass : Verdict::kFail, std::move(figure), limit, finding};
}

CheckResult skipped(const std::string& name, const std::string& why) {
  return {name, Verdict::kSkipped, {}, "", why};
}

CheckResult missing(const std::string& name, const std::string& finding) {
  return {name, Verdict::kFail, {}, "", finding};
}

bool any_failed(const CheckResults& results) {
  return std::any_of(results.begin(), results.end(),
                     [](const CheckResult& result) { return result.verdict == Verdict::kFail; });
}

bool passes(const CheckResults& results, const std::string& name) {
  return std::any_of(results.begin(), results.end(), [&](const CheckResult& result) {
    return result.name == name && result.verdict == Verdict::kPass;
  });
}

void append(CheckResults& results, CheckResults more) {
  std::move(more.begin(), more.end(), std::back_inserter(results));
}

}  // namespace swiftlet::ground
