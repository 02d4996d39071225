#include "swiftlet/services/control/plan_store.hpp"

#include <memory>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mission.hpp"

namespace swiftlet::services::plan_store_test {

using control::Mission;
using MissionStore = PlanStore<Mission>;

std::unique_ptr<Mission> mission(std::uint64_t id) {
  auto mission = std::make_unique<Mission>();
  mission->id = id;
  mission->items.resize(1);
  return mission;
}

TEST(PlanStore, FindsTheNewestOfAnId) {
  MissionStore store;
  EXPECT_EQ(store.find(1), nullptr);
  store.put(mission(1));
  const Mission* const first = store.find(1);
  ASSERT_NE(first, nullptr);
  store.put(mission(1));
  EXPECT_NE(store.find(1), first);
}

TEST(PlanStore, EvictsTheOldest) {
  MissionStore store;
  for (std::uint64_t id = 1; id <= MissionStore::kCapacity + 2; ++id) store.put(mission(id));
  store.tidy(0);
  EXPECT_EQ(store.size(), MissionStore::kCapacity);
  EXPECT_EQ(store.find(1), nullptr);
  EXPECT_EQ(store.find(2), nullptr);
  EXPECT_NE(store.find(3), nullptr);
}

TEST(PlanStore, KeepsTheFlownMission) {
  MissionStore store;
  store.put_flown(mission(1));
  for (std::uint64_t id = 2; id <= 20; ++id) {
    store.put(mission(id));
    store.tidy(0);
  }
  EXPECT_NE(store.find(1), nullptr);
  store.put_flown(mission(21));
  store.tidy(0);
  EXPECT_EQ(store.find(1), nullptr);
  EXPECT_NE(store.find(21), nullptr);
}

TEST(PlanStore, KeepsALentMissionUntilALaterStateIsTaken) {
  MissionStore store;
  store.put(mission(1));
  store.lend(store.find(1), 5);
  for (std::uint64_t id = 2; id <= 20; ++id) store.put(mission(id));
  store.tidy(4);
  EXPECT_NE(store.find(1), nullptr) << "sent but not taken";
  store.tidy(5);
  EXPECT_NE(store.find(1), nullptr) << "in use";
  EXPECT_EQ(store.size(), MissionStore::kCapacity);
  store.put(mission(21));
  store.tidy(6);
  EXPECT_EQ(store.find(1), nullptr);
}

}  // namespace swiftlet::services::plan_store_test
