#include "swiftlet/services/rtps/announcement.hpp"

#include <gtest/gtest.h>

namespace swiftlet::rtps::announcement_test {

std::vector<std::uint8_t> bytes(const std::string& text) { return {text.begin(), text.end()}; }

Announcement plant(std::int64_t since_ns, bool is_established) {
  return {"kl1", "lab1", 42, "imu", since_ns, is_established};
}

TEST(Announcement, ArrivesUnchanged) {
  const Announcement sent{"kl1,kl2", "lab1", 4711, "imu", 1'700'000'000'123'456'789, true, true};
  const Announcement received = from_user_data(to_user_data(sent));
  EXPECT_EQ(received.vehicles, sent.vehicles);
  EXPECT_EQ(received.host, sent.host);
  EXPECT_EQ(received.pid, sent.pid);
  EXPECT_EQ(received.source_of, sent.source_of);
  EXPECT_EQ(received.since_ns, sent.since_ns);
  EXPECT_TRUE(received.is_established);
  EXPECT_TRUE(received.hears_of_own_vehicles);
}

TEST(Announcement, OfAnotherProgramLeavesFieldsEmpty) {
  for (const char* text : {"", "enclave=/;", "enclave=/;vehicle", ";;=;process=x;", "myvehicle=kl1;"}) {
    const Announcement received = from_user_data(bytes(text));
    EXPECT_EQ(received.vehicles, "") << text;
    EXPECT_EQ(received.host, "") << text;
    EXPECT_EQ(received.pid, 0) << text;
    EXPECT_EQ(received.source_of, "") << text;
    EXPECT_FALSE(received.is_established) << text;
    EXPECT_FALSE(received.hears_of_own_vehicles) << text;
  }
}

TEST(Announcement, ListsWholeNames) {
  EXPECT_TRUE(lists("kl1,kl2", "kl2"));
  EXPECT_FALSE(lists("kl12", "kl1"));
  EXPECT_EQ(split_names("kl1,,kl2"), (std::vector<std::string>{"kl1", "kl2"}));
  EXPECT_TRUE(split_names("").empty());
}

TEST(Apart, AreProcessesOfDifferentVehiclesThatNeedNotKnowOfEachOther) {
  const auto apart = [](const std::string& own, const std::string& other) {
    return are_apart("enclave=/;" + own, "enclave=/;" + other) && are_apart(other, own);
  };
  EXPECT_TRUE(apart("vehicle=kl1;hears=own;", "vehicle=kl2;host=lab;hears=own;"));
  EXPECT_TRUE(apart("vehicle=kl1,kl2;hears=own;", "vehicle=kl12;hears=own;"));
  EXPECT_FALSE(apart("vehicle=kl1,kl2;hears=own;", "vehicle=kl3,kl2;hears=own;")) << "both serve kl2";
  EXPECT_FALSE(apart("vehicle=kl1;hears=own;", "vehicle=kl2;")) << "a tool";
  EXPECT_FALSE(apart("vehicle=kl1;hears=own;", "vehicle=;hears=own;")) << "of no vehicle yet";
  EXPECT_FALSE(apart("vehicle=kl1;hears=own;", "")) << "a program of others";
}

TEST(SourceOrder, ANewOneYieldsToAnEstablishedOne) {
  EXPECT_TRUE(yields(plant(1, false), plant(2, true)));
  EXPECT_FALSE(yields(plant(2, true), plant(1, false)));
}

TEST(SourceOrder, ExactlyOneOfTwoYields) {
  Announcement same_time = plant(1, false);
  same_time.pid = 43;
  for (const Announcement& other : {plant(2, false), same_time}) {
    EXPECT_FALSE(yields(plant(1, false), other));
    EXPECT_TRUE(yields(other, plant(1, false)));
  }
}

}  // namespace swiftlet::rtps::announcement_test
