#include "swiftlet/io/text_file.hpp"

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::io::text_file_test {

TEST(Printable, ReplacesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("mass: 3 \xc2\xb5m\nline"), "mass: 3 \xc2\xb5m\nline");
  EXPECT_EQ(printable("\x1b[31m\r\t\x7f"), "?[31m???");
  EXPECT_EQ(printable("\xff\xfe\xc2\x9b"), "???");  // no UTF-8; the last is a control character of two bytes
  EXPECT_EQ(printable("\xe2\x82"), "??");           // cut
}

TEST(Printable, CutsLongTexts) {
  const std::string text = printable(std::string(100'000, 'x'));
  EXPECT_LT(text.size(), 2100U);
  EXPECT_EQ(text.substr(text.size() - 4), "x...");
}

TEST(Printable, AppliesToErrors) {
  EXPECT_STREQ(ConfigError("a.csv", 1, "x\x90", "is \x1b").what(), "a.csv:1: x?: is ?");
}

TEST(ControlCharacters, AreFoundWithTheirLine) {
  EXPECT_EQ(line_of_control_character("a,b\r\n1,2\t\n\xff"), 0);
  EXPECT_EQ(line_of_control_character(std::string("a,b\n1,\0\n", 8)), 2);
}

}  // namespace swiftlet::io::text_file_test
