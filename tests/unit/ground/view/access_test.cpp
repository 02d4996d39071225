#include "swiftlet/ground/view/access.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::access_test {

TEST(Access, OfLoopbackIsForItsNamesOnly) {
  const Access access;
  for (const char* host : {"localhost", "localhost:8765", "127.0.0.1:8765", "127.1.2.3", "[::1]:8765"})
    EXPECT_FALSE(refusal_of({"/", host, ""}, access)) << host;
  // A page that a name server leads here has a name of its own.
  for (const char* host :
       {"evil.example:8765", "127.0.0.1.evil.example", "localhost.evil.example", "192.168.1.2", "[::2]"})
    EXPECT_TRUE(refusal_of({"/", host, ""}, access)) << host;
  EXPECT_TRUE(refusal_of({"/", "", ""}, access));
}

TEST(Access, IsNotForPagesOfOthers) {
  Access access;
  EXPECT_FALSE(refusal_of({"/", "localhost:8765", "http://localhost:8765"}, access));
  for (const char* origin : {"http://evil.example", "https://localhost:8765", "http://localhost",
                             "http://localhost:80", "null", "file://"})
    EXPECT_TRUE(refusal_of({"/", "localhost:8765", origin}, access)) << origin;
  access.origins = {"https://app.foxglove.dev"};
  EXPECT_FALSE(refusal_of({"/", "localhost:8765", "https://app.foxglove.dev"}, access));
  EXPECT_TRUE(refusal_of({"/", "localhost:8765", "https://app.foxglove.dev.evil.example"}, access));
}

TEST(Access, NeedsTheTokenIfThereIsOne) {
  const Access access{"00ff", {}};
  EXPECT_FALSE(refusal_of({"/?token=00ff", "lab1:8765", ""}, access));
  EXPECT_FALSE(refusal_of({"/?newest=&token=00ff", "lab1:8765", "http://lab1:8765"}, access));
  for (const char* target :
       {"/", "/?token", "/?token=", "/?token=00f", "/?token=00ff0", "/?token=00fe", "/?other=00ff"})
    EXPECT_TRUE(refusal_of({target, "lab1:8765", ""}, access)) << target;
  EXPECT_TRUE(refusal_of({"/?token=00ff", "lab1:8765", "http://evil.example"}, access));
}

TEST(Access, TokensAre128RandomBits) {
  const std::string one = make_token();
  EXPECT_EQ(one.size(), 32U);
  EXPECT_EQ(one.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(one, make_token());
}

TEST(Access, ReadsTargets) {
  EXPECT_EQ(path_of("/a?b=c"), "/a");
  EXPECT_EQ(path_of("/a"), "/a");
  EXPECT_EQ(query_value("/?a=1&b=2", "b"), "2");
  EXPECT_EQ(query_value("/?ab=1", "b"), "");
  EXPECT_TRUE(has_query("/?newest", "newest"));
  EXPECT_TRUE(has_query("/?token=1&newest=", "newest"));
  EXPECT_FALSE(has_query("/newest", "newest"));
}

}  // namespace swiftlet::ground::access_test
