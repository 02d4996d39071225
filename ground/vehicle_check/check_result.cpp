#include "swiftlet/ground/vehicle_check/check_result.hpp"

#include <algorithm>
#include <iterator>

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

bool has_verdict(const CheckResults& results, const std::string& name, Verdict verdict) {
  return std::any_of(results.begin(), results.end(), [&](const CheckResult& result) {
    return result.name == name && result.verdict == verdict;
  });
}

void append(CheckResults& results, CheckResults more) {
  std::move(more.begin(), more.end(), std::back_inserter(results));
}

}  // namespace swiftlet::ground
