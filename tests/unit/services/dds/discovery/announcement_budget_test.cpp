#include "swiftlet/services/dds/discovery/announcement_budget.hpp"

#include <gtest/gtest.h>

namespace swiftlet::comms {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

// Copies that a process sends in ten seconds at a steady rate, after its first announcements are over.
int copies_in_ten_seconds(std::size_t processes, int announcements_per_second) {
  AnnouncementBudget budget;
  std::int64_t now_ns = kSecond_ns;
  const auto send_for = [&](int seconds) {
    int copies = 0;
    for (int i = 0; i < seconds * announcements_per_second; ++i) {
      now_ns += kSecond_ns / announcements_per_second;
      copies += budget.copies(1, processes, now_ns);
    }
    return copies;
  };
  send_for(10);
  return send_for(10);
}

TEST(AnnouncementBudget, LeavesAFewProcessesAsTheyAre) {
  EXPECT_EQ(copies_in_ten_seconds(1, 10), 10 * 10 * kAnnouncementCopies);
  EXPECT_EQ(copies_in_ten_seconds(7, 10), 10 * 10 * kAnnouncementCopies);
}

TEST(AnnouncementBudget, BoundsWhatAProcessTakesIn) {
  for (const std::size_t processes : {15U, 30U, 60U, 100U, 150U}) {
    const double heard_per_second =
        copies_in_ten_seconds(processes, 50) / 10.0 * static_cast<double>(processes);
    EXPECT_LE(heard_per_second, 4.0 * kHeardAnnouncements) << processes << " processes";
    const double heard_at_rest_per_second =
        copies_in_ten_seconds(processes, 10) / 10.0 * static_cast<double>(processes);
    EXPECT_LE(heard_at_rest_per_second, 1.02 * kHeardAnnouncements) << processes << " processes";
  }
}

TEST(AnnouncementBudget, KeepsAProcessAliveAmongAnyNumber) {
  EXPECT_NEAR(copies_in_ten_seconds(100'000, 10), 10.0 * kLeastAnnouncements, 1.0);
}

TEST(AnnouncementBudget, NeverHoldsBackNews) {
  AnnouncementBudget budget;
  int copies = 1;
  for (int i = 0; i < 100 && copies > 0; ++i) copies = budget.copies(1, 100, kSecond_ns);
  ASSERT_EQ(copies, 0) << "what was said before";
  EXPECT_EQ(budget.copies(2, 100, kSecond_ns), kAnnouncementCopies);
  EXPECT_EQ(budget.copies(2, 100, kSecond_ns), 0);
}

TEST(AnnouncementBudget, LetsAProcessBeginWithItsFirstAnnouncements) {
  AnnouncementBudget budget;
  for (int i = 0; i < 20; ++i) EXPECT_GT(budget.copies(1, 100, kSecond_ns), 0) << i;
}

TEST(EndpointCopies, AreFewerInALargeDomain) {
  EXPECT_EQ(endpoint_copies(6), kEndpointCopies);
  EXPECT_EQ(endpoint_copies(100), 2);
}

}  // namespace
}  // namespace swiftlet::comms
