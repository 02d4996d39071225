#include "swiftlet/ground/cli/check/check_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/json_text.hpp"

namespace swiftlet::ground {
namespace {

using nlohmann::ordered_json;

std::ptrdiff_t count(const CheckResults& results, Verdict verdict) {
  return std::count_if(results.begin(), results.end(),
                       [&](const CheckResult& result) { return result.verdict == verdict; });
}

const char* json_verdict(Verdict verdict) {
  if (verdict == Verdict::kFail) return "fail";
  return to_string(verdict);
}

}  // namespace

void print_table(std::FILE* stream, const std::string& vehicle, const CheckResults& results) {
  std::size_t width = 0;
  for (const CheckResult& result : results) width = std::max(width, result.name.size());
  for (const CheckResult& result : results) {
    const bool measured = !result.figure.text.empty();
    fmt::print(stream, "{:<{}}  {:<7}  {}\n", result.name, width, to_string(result.verdict),
               measured ? result.figure.text + "  (" + result.limit + ")" : result.finding);
    if (measured && !result.finding.empty()) fmt::print(stream, "{:<{}}    {}\n", "", width, result.finding);
  }
  fmt::print(stream, "{}: {} checks passed, {} failed, {} skipped\n", vehicle, count(results, Verdict::kPass),
             count(results, Verdict::kFail), count(results, Verdict::kSkipped));
}

void print_json(const std::string& vehicle, int domain, const CheckResults& results) {
  ordered_json json = {{"vehicle", vehicle},
                       {"domain", domain},
                       {"passed", count(results, Verdict::kPass)},
                       {"failed", count(results, Verdict::kFail)},
                       {"skipped", count(results, Verdict::kSkipped)},
                       {"checks", ordered_json::array()}};
  for (const CheckResult& result : results) {
    const bool measured = !result.figure.text.empty() && std::isfinite(result.figure.value);
    json["checks"].push_back({{"name", result.name},
                              {"verdict", json_verdict(result.verdict)},
                              {"value", measured ? ordered_json(result.figure.value) : ordered_json()},
                              {"unit", result.figure.unit},
                              {"figure", result.figure.text},
                              {"limit", result.limit},
                              {"finding", result.finding}});
  }
  fmt::print("{}\n", io::json_text(json, 2));
}

}  // namespace swiftlet::ground
