// The result of one check of a vehicle.
#pragma once

#include <string>
#include <vector>

namespace swiftlet::ground {

enum class Verdict { kPass, kFail, kSkipped };
const char* to_string(Verdict verdict);  // "pass", "FAIL", "skipped"

// What a check has measured. `text` is for people: value with unit, and further figures.
struct Figure {
  double value = 0.0;
  std::string unit;
  std::string text;
};

struct CheckResult {
  std::string name;  // "imu.rate": topic or subject, and what is checked
  Verdict verdict = Verdict::kSkipped;
  Figure figure;        // empty text: nothing was measured
  std::string limit;    // "500 Hz +- 5 %"
  std::string finding;  // failure: the likely defect, a sentence; skipped: why
};
using CheckResults = std::vector<CheckResult>;

CheckResult skipped(const std::string& name, const std::string& why);
// A failure because nothing was measured.
CheckResult missing(const std::string& name, const std::string& finding);

bool any_failed(const CheckResults& results);
// False unless the check is among the results with this verdict.
bool has_verdict(const CheckResults& results, const std::string& name, Verdict verdict);
inline bool passes(const CheckResults& results, const std::string& name) {
  return has_verdict(results, name, Verdict::kPass);
}
void append(CheckResults& results, CheckResults more);

}  // namespace swiftlet::ground
