// A short soak, and every flight that once left the fence or ended upside down.
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/soak/soak_flight.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::soak {
namespace {

const SoakSetup& setup() {
  static const SoakSetup kSetup = load_setup("motor_lag");
  return kSetup;
}

std::vector<std::uint64_t> regression_seeds() {
  std::ifstream file(tests::in_source("tests/soak/seeds.txt"));
  std::vector<std::uint64_t> seeds;
  for (std::string line; std::getline(file, line);) {
    if (!line.empty() && line.front() != '#') seeds.push_back(std::stoull(line));
  }
  return seeds;
}

class SoakFlights : public testing::TestWithParam<std::uint64_t> {};

TEST_P(SoakFlights, StaysInsideTheFenceAndUpright) {
  const SoakFlight flight = fly(setup(), GetParam());
  EXPECT_FALSE(flight.violation.has_value()) << flight.violation->what << " at " << flight.violation->at_s
                                             << " s; repeat with: ./dev soak faults --flight " << flight.seed;
  EXPECT_GT(flight.take_offs, 0);
}

INSTANTIATE_TEST_SUITE_P(First, SoakFlights, testing::Range<std::uint64_t>(1, 6),
                         [](const auto& seed) { return std::to_string(seed.param); });
INSTANTIATE_TEST_SUITE_P(Regression, SoakFlights, testing::ValuesIn(regression_seeds()),
                         [](const auto& seed) { return std::to_string(seed.param); });

TEST(FaultsSoak, FlightRepeatsWithItsSeed) {
  const SoakFlight one = fly(setup(), 3);
  const SoakFlight again = fly(setup(), 3);
  EXPECT_EQ(one.airborne_s, again.airborne_s);
  EXPECT_EQ(one.take_offs, again.take_offs);
  EXPECT_EQ(one.most_outside_m, again.most_outside_m);
  ASSERT_EQ(one.faults.size(), again.faults.size());
  EXPECT_GT(one.faults.size(), 10U);
  for (std::size_t i = 0; i < one.faults.size(); ++i) {
    EXPECT_EQ(one.faults[i].consequence, again.faults[i].consequence);
  }
}

}  // namespace
}  // namespace swiftlet::soak
