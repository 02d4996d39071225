// What is expected of the results of checks.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/ground/vehicle_check/check_result.hpp"

namespace swiftlet::tests {

inline std::string text_of(const ground::CheckResults& results) {
  std::string text;
  for (const ground::CheckResult& result : results)
    text += result.name + ": " + ground::to_string(result.verdict) + ", " + result.figure.text + ", " +
            result.finding + "\n";
  return text;
}

// Every check passes; at most the skipped ones of `may_skip` do not.
inline void expect_sound(const ground::CheckResults& results, const std::vector<std::string>& may_skip = {}) {
  ASSERT_FALSE(results.empty());
  for (const ground::CheckResult& result : results) {
    const bool skips = std::count(may_skip.begin(), may_skip.end(), result.name) > 0;
    EXPECT_EQ(result.verdict, skips ? ground::Verdict::kSkipped : ground::Verdict::kPass)
        << result.name << ": " << result.figure.text << ": " << result.finding;
  }
}

// The check fails, and its finding has these words.
inline void expect_names(const ground::CheckResults& results, const std::string& check,
                         const std::string& words) {
  const auto found =
      std::find_if(results.begin(), results.end(), [&](const auto& result) { return result.name == check; });
  ASSERT_NE(found, results.end()) << check << " is not among\n" << text_of(results);
  EXPECT_EQ(found->verdict, ground::Verdict::kFail) << check << "\n" << text_of(results);
  EXPECT_NE(found->finding.find(words), std::string::npos) << check << ": " << found->finding;
}

}  // namespace swiftlet::tests
