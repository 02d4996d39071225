#include "services/comms/awakening.hpp"

#include <atomic>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"

namespace swiftlet::comms {
namespace {

using namespace std::chrono_literals;
using swiftlet::tests::eventually;

TEST(Awakening, EndsAtOnceAlsoWhileItWaits) {
  const auto start = std::chrono::steady_clock::now();
  {
    const Awakening awakening(1h, [](auto) { return true; });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1min);
}

TEST(Awakening, CallsUntilItIsDone) {
  std::atomic<int> calls{0};
  const Awakening awakening(-1ms, [&](auto) { return ++calls == 3; });  // each look is late
  EXPECT_TRUE(eventually([&] { return calls > 6; }));
}

}  // namespace
}  // namespace swiftlet::comms
