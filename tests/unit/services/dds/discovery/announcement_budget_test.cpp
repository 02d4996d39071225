#include "swiftlet/services/dds/discovery/announcement_budget.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace swiftlet::dds::announcement_budget_test {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::size_t kFew = 12;  // so many are few

constexpr std::int64_t kKnown = 1;   // the destination has been discovered long ago
constexpr std::int64_t kAnyone = 0;  // it is a multicast address

// Copies that a process sends in ten seconds at a steady rate, after its first announcements are over.
int copies_in_ten_seconds(std::size_t processes, int announcements_per_second,
                          std::int64_t joined_ns = kKnown) {
  AnnouncementBudget budget;
  std::int64_t now_ns = kSecond_ns;
  const auto send_for = [&](int seconds) {
    int copies = 0;
    for (int i = 0; i < seconds * announcements_per_second; ++i) {
      now_ns += kSecond_ns / announcements_per_second;
      copies += budget.copies(1, processes, joined_ns, now_ns);
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
  for (int i = 0; i < 100 && copies > 0; ++i) copies = budget.copies(1, 100, kKnown, kSecond_ns);
  ASSERT_EQ(copies, 0) << "what was said before";
  EXPECT_EQ(budget.copies(2, 100, kKnown, kSecond_ns), kAnnouncementCopies);
  EXPECT_EQ(budget.copies(2, 100, kKnown, kSecond_ns), 0);
}

TEST(AnnouncementBudget, LetsAProcessBeginWithItsFirstAnnouncements) {
  for (const std::int64_t joined_ns : {kKnown, kAnyone}) {
    AnnouncementBudget budget;
    for (int i = 0; i < 20; ++i)
      EXPECT_GT(budget.copies(1, kFew, joined_ns, kSecond_ns), 0) << i << " of a few processes";
  }
}

TEST(AnnouncementBudget, LetsAProcessOfManyBeginWithFewer) {
  for (const std::int64_t joined_ns : {kKnown, kAnyone}) {
    AnnouncementBudget budget;
    int copies = 0;
    for (int i = 0; i < 20; ++i) copies += budget.copies(1, 200, joined_ns, kSecond_ns);
    EXPECT_GE(copies, 2);
    EXPECT_LE(copies, 3);
  }
}

TEST(AnnouncementBudget, BoundsWhatAllTakeInThatGoesToAnyone) {
  EXPECT_EQ(copies_in_ten_seconds(kFew, 10, kAnyone), copies_in_ten_seconds(kFew, 10)) << "of a few";
  for (const std::size_t processes : {20U, 40U, 80U, 120U, 200U}) {
    const auto count = static_cast<double>(processes);
    const double heard_per_second = copies_in_ten_seconds(processes, 10, kAnyone) / 10.0 * count;
    // One announcement more or less in ten seconds.
    EXPECT_LE(heard_per_second, kHeardByAnyone + 0.1 * count) << processes << " processes";
    EXPECT_LE(heard_per_second * count, kHeardByAll + 0.1 * count * count) << processes << " processes";
    EXPECT_GE(heard_per_second, 0.5 * std::min(kHeardByAnyone, kHeardByAll / count))
        << processes << " processes";
  }
}

TEST(AnnouncementBudget, AnswersANewcomerAtOnce) {
  AnnouncementBudget budget;
  std::int64_t now_ns = kSecond_ns;
  while (budget.copies(1, 200, kKnown, now_ns) > 0) now_ns += 1000;
  EXPECT_EQ(budget.copies(1, 200, kKnown, now_ns + 2), 0);
  EXPECT_GT(budget.copies(1, 200, now_ns + 3, now_ns + 4), 0) << "at the port of an earlier process";
  EXPECT_EQ(budget.copies(1, 200, now_ns + 3, now_ns + 5), 0) << "it has this one already";
}

TEST(EndpointCopies, AreFewerInALargeDomain) {
  EXPECT_EQ(endpoint_copies(6), kEndpointCopies);
  EXPECT_EQ(endpoint_copies(30), 2);
  EXPECT_EQ(endpoint_copies(100), 1);
}

}  // namespace swiftlet::dds::announcement_budget_test
