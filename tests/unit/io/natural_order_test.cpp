#include "swiftlet/io/natural_order.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::io::natural_order_test {

TEST(NaturalOrder, CountsByNumber) {
  const std::vector<std::string> ordered = {"",      "7",   "07a",   "a",      "kl",   "kl1",
                                            "kl01a", "kl2", "kl2-1", "kl2-10", "kl10", "kla"};
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    for (std::size_t k = 0; k < ordered.size(); ++k)
      EXPECT_EQ(comes_before(ordered[i], ordered[k]), i < k) << ordered[i] << " and " << ordered[k];
  }
  EXPECT_NE(comes_before("01", "1"), comes_before("1", "01")) << "no two texts are equal";
}

TEST(NaturalOrder, CountsBeyondTheLargestInteger) {
  EXPECT_TRUE(comes_before("9" + std::string(30, '9'), "1" + std::string(31, '0')));
}

}  // namespace swiftlet::io::natural_order_test
