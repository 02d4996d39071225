#include "swiftlet/services/dds/limited_log.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/log_text.hpp"

namespace swiftlet::dds::limited_log_test {

using namespace std::chrono_literals;

TEST(LimitedLog, WritesEachLineOnceInAPeriod) {
  const tests::LogText text;
  const LimitedLog::Time start{1h};
  LimitedLog log;
  log.warn("a", start);
  log.warn("b", start + 1s);
  log.warn("a", start + LimitedLog::kPeriod - 1ms);
  EXPECT_EQ(text.lines(), "a\nb\n");
  log.warn("a", start + LimitedLog::kPeriod);
  EXPECT_EQ(text.lines(), "a\nb\na\n");
}

TEST(LimitedLog, WritesFewLinesInAPeriod) {
  tests::LogText text;
  const LimitedLog::Time start{1h};
  LimitedLog log;
  std::string expected;
  for (std::size_t i = 0; i < 3 * LimitedLog::kMostLines; ++i) {
    log.warn(std::to_string(i), start);
    if (i < LimitedLog::kMostLines) expected += std::to_string(i) + "\n";
  }
  EXPECT_EQ(text.lines(), expected);
  text.clear();
  log.warn("last", start + LimitedLog::kPeriod);
  EXPECT_EQ(text.lines(), "last\n");
}

}  // namespace swiftlet::dds::limited_log_test
