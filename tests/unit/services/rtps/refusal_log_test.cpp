#include "swiftlet/services/rtps/refusal_log.hpp"

#include <chrono>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/log_text.hpp"

namespace swiftlet::rtps::refusal_log_test {

using namespace std::chrono_literals;

class RefusalLogTest : public testing::Test {
 protected:
  void refuse(std::uint8_t host, const char* rule, int times = 1) {
    for (int i = 0; i < times; ++i) log_.note(0x0a000000U + host, rule);
  }
  std::string lines_after(std::chrono::steady_clock::duration time) {
    text_.clear();
    log_.write_due(start_ + time);
    return text_.lines();
  }

  RefusalLog log_;

 private:
  const std::chrono::steady_clock::time_point start_{1h};
  tests::LogText text_;
};

TEST_F(RefusalLogTest, NamesEachSenderAndItsLastRuleOnceInAPeriod) {
  refuse(1, "first rule");
  refuse(1, "second rule");
  refuse(2, "third rule");
  EXPECT_EQ(lines_after(0s),
            "refused 2 datagrams from 10.0.0.1; the last: second rule\n"
            "refused 1 datagram from 10.0.0.2; the last: third rule\n");
  refuse(1, "first rule", 5);
  EXPECT_EQ(lines_after(kRefusalLogPeriod - 1ms), "");
  EXPECT_EQ(lines_after(kRefusalLogPeriod), "refused 5 datagrams from 10.0.0.1; the last: first rule\n");
  EXPECT_EQ(log_.total(), 8U);
}

TEST_F(RefusalLogTest, CountsMoreSendersThanItRemembersTogether) {
  for (std::uint8_t host = 1; host <= 18; ++host) refuse(host, "rule");
  const std::string lines = lines_after(0s);
  EXPECT_NE(lines.find("refused 1 datagram from 10.0.0.15; "), std::string::npos) << lines;
  EXPECT_NE(lines.find("refused 3 datagrams from other senders; the last: rule\n"), std::string::npos)
      << lines;
  EXPECT_EQ(lines_after(kRefusalLogPeriod), "") << "all were silent, and are forgotten";
  refuse(18, "rule");
  EXPECT_EQ(lines_after(kRefusalLogPeriod), "refused 1 datagram from 10.0.0.18; the last: rule\n");
}

}  // namespace swiftlet::rtps::refusal_log_test
