// The fixture of the tests of a supervised flight.
#pragma once

#include <gtest/gtest.h>

#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::tests {

class FlightTest : public testing::Test, protected SupervisedFlight {
 protected:
  void hover() { ASSERT_TRUE(take_off()); }
};

}  // namespace swiftlet::tests
