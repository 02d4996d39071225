#include "swiftlet/services/control/plan_store.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mission.hpp"

namespace swiftlet::services {
namespace {

using control::Mission;
using Shelf = PlanStore<Mission>;

std::unique_ptr<Mission> mission(std::uint64_t id) {
  auto mission = std::make_unique<Mission>();
  mission->id = id;
  mission->items.resize(1);
  return mission;
}

TEST(PlanStore, FindsTheNewestOfAnId) {
  Shelf shelf;
  EXPECT_EQ(shelf.find(1), nullptr);
  shelf.put(mission(1));
  const Mission* const first = shelf.find(1);
  ASSERT_NE(first, nullptr);
  shelf.put(mission(1));
  EXPECT_NE(shelf.find(1), first);
}

TEST(PlanStore, TheOldestMakeRoom) {
  Shelf shelf;
  for (std::uint64_t id = 1; id <= Shelf::kCapacity + 2; ++id) shelf.put(mission(id));
  shelf.tidy(0);
  EXPECT_EQ(shelf.size(), Shelf::kCapacity);
  EXPECT_EQ(shelf.find(1), nullptr);
  EXPECT_EQ(shelf.find(2), nullptr);
  EXPECT_NE(shelf.find(3), nullptr);
}

TEST(PlanStore, WhatIsFlownStays) {
  Shelf shelf;
  shelf.put_flown(mission(1));
  for (std::uint64_t id = 2; id <= 20; ++id) {
    shelf.put(mission(id));
    shelf.tidy(0);
  }
  EXPECT_NE(shelf.find(1), nullptr);
  shelf.put_flown(mission(21));
  shelf.tidy(0);
  EXPECT_EQ(shelf.find(1), nullptr);
  EXPECT_NE(shelf.find(21), nullptr);
}

TEST(PlanStore, WhatWasLentStaysUntilALaterHandoverIsTaken) {
  Shelf shelf;
  shelf.put(mission(1));
  shelf.lend(shelf.find(1), 5);
  for (std::uint64_t id = 2; id <= 20; ++id) shelf.put(mission(id));
  shelf.tidy(4);
  EXPECT_NE(shelf.find(1), nullptr) << "on its way";
  shelf.tidy(5);
  EXPECT_NE(shelf.find(1), nullptr) << "in use";
  EXPECT_EQ(shelf.size(), Shelf::kCapacity);
  shelf.put(mission(21));
  shelf.tidy(6);
  EXPECT_EQ(shelf.find(1), nullptr);
}

}  // namespace
}  // namespace swiftlet::services
