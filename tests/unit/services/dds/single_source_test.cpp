#include "swiftlet/services/dds/single_source.hpp"

#include <gtest/gtest.h>

namespace swiftlet::dds::single_source_test {

using namespace std::chrono_literals;

class SingleSourceTest : public testing::Test {
 protected:
  bool accepts(int id, std::chrono::milliseconds at) { return source_.accepts(id, start_ + at); }

  const SingleSource<int>::Time start_{1h};
  SingleSource<int> source_{200ms};
};

TEST_F(SingleSourceTest, KeepsTheOneThatWasHeardFirst) {
  EXPECT_TRUE(accepts(1, 0ms));
  for (int i = 1; i < 100; ++i) {
    EXPECT_FALSE(accepts(2, i * 100ms));
    EXPECT_TRUE(accepts(1, i * 100ms));
  }
  EXPECT_EQ(source_.id(), 1);
}

TEST_F(SingleSourceTest, TakesTheNextOneAfterASilence) {
  EXPECT_TRUE(accepts(1, 0ms));
  EXPECT_FALSE(accepts(2, 199ms));
  EXPECT_TRUE(accepts(2, 200ms));
  EXPECT_FALSE(accepts(1, 210ms)) << "now the other one is the source";
}

TEST_F(SingleSourceTest, KeepsASlowSourceThatIsAlone) {
  EXPECT_TRUE(accepts(1, 0ms));
  EXPECT_TRUE(accepts(1, 5000ms));
}

}  // namespace swiftlet::dds::single_source_test
