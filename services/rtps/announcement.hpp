// What a process announces about itself to the other processes of the domain, in the user data of its
// participant.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace swiftlet::rtps {

struct Announcement {
  std::string vehicles;  // that it serves: "kl1,kl2"; may be empty
  std::string host;      // empty: not announced, as by programs of others
  int pid = 0;
  std::string source_of;        // topic of which it is to be the only source (NodeSettings); empty: none
  std::int64_t since_ns = 0;    // when it joined, on the clock of its host
  bool is_established = false;  // it has not found another source and publishes
  // It ignores the processes that are_apart() from it.
  bool hears_of_own_vehicles = false;
};

// The user data, "enclave=/;vehicle=kl1;host=lab1;process=4711;": keys and values, in the syntax of ROS 2,
// which expects the enclave.
std::vector<std::uint8_t> to_user_data(const Announcement& announcement);
// Keys that are missing or malformed leave their field empty.
Announcement from_user_data(const std::vector<std::uint8_t>& user_data);

// True if neither of two processes serves a vehicle of the other, and both say that they need not know of each other.
// Each of them then ignores the other. own, other: user data, or only its keys "vehicle" and "hears".
bool are_apart(std::string_view own, std::string_view other);

// True if a list of names, "kl1,kl2", contains the name.
bool lists(const std::string& names, const std::string& name);
std::vector<std::string> split_names(const std::string& names);

// Decides whether `own` yields to `other`, if both are to be the only source of a topic. The one that is not
// established yields to the established one. Otherwise the one that joined later yields, so that exactly one of
// them stays; host and process number decide between equal times.
bool yields(const Announcement& own, const Announcement& other);

}  // namespace swiftlet::rtps
