#include "swiftlet/io/json_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace swiftlet::io::json_text_test {

TEST(JsonText, BytesThatAreNoUtf8BecomeTheReplacementCharacter) {
  EXPECT_EQ(json_text(nlohmann::json{{"mission", "b\xff\xe9"}}),
            "{\"mission\":\"b\xef\xbf\xbd\xef\xbf\xbd\"}");
  EXPECT_EQ(json_text(nlohmann::json{{"mission", "\xc3\xa9"}}, 1), "{\n \"mission\": \"\xc3\xa9\"\n}");
}

}  // namespace swiftlet::io::json_text_test
