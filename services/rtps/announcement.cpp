#include "swiftlet/services/rtps/announcement.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "swiftlet/io/text.hpp"

namespace swiftlet::rtps {
namespace {

constexpr std::string_view kOwnVehicles = "own";  // value of the key "hears"

// Takes what is before the separator off the text.
std::string_view take_until(char separator, std::string_view& text) {
  const std::string_view part = text.substr(0, text.find(separator));
  text.remove_prefix(std::min(text.size(), part.size() + 1));
  return part;
}

std::string_view value_of(std::string_view text, std::string_view key) {
  while (!text.empty()) {
    std::string_view value = take_until(';', text);
    if (take_until('=', value) == key) return value;
  }
  return {};
}

}  // namespace

std::vector<std::uint8_t> to_user_data(const Announcement& announcement) {
  std::string text = "enclave=/;vehicle=" + announcement.vehicles + ";host=" + announcement.host +
                     ";process=" + std::to_string(announcement.pid) + ";";
  if (announcement.hears_of_own_vehicles) text += "hears=" + std::string(kOwnVehicles) + ";";
  if (!announcement.source_of.empty()) {
    text += "source_of=" + announcement.source_of + ";since=" + std::to_string(announcement.since_ns) +
            ";established=" + (announcement.is_established ? "1" : "0") + ";";
  }
  return {text.begin(), text.end()};
}

Announcement from_user_data(const std::vector<std::uint8_t>& user_data) {
  const std::string text(user_data.begin(), user_data.end());
  Announcement announcement;
  announcement.vehicles = value_of(text, "vehicle");
  announcement.host = value_of(text, "host");
  announcement.pid = std::atoi(std::string(value_of(text, "process")).c_str());
  announcement.source_of = value_of(text, "source_of");
  announcement.since_ns = std::strtoll(std::string(value_of(text, "since")).c_str(), nullptr, 10);
  announcement.is_established = value_of(text, "established") == "1";
  announcement.hears_of_own_vehicles = value_of(text, "hears") == kOwnVehicles;
  return announcement;
}

bool are_apart(std::string_view own, std::string_view other) {
  for (const std::string_view text : {own, other}) {
    if (value_of(text, "hears") != kOwnVehicles || value_of(text, "vehicle").empty()) return false;
  }
  std::string_view vehicles = value_of(own, "vehicle");
  while (!vehicles.empty()) {
    const std::string_view vehicle = take_until(',', vehicles);
    std::string_view others = value_of(other, "vehicle");
    while (!others.empty()) {
      if (take_until(',', others) == vehicle) return false;
    }
  }
  return true;
}

bool lists(const std::string& names, const std::string& name) {
  return ("," + names + ",").find("," + name + ",") != std::string::npos;
}

std::vector<std::string> split_names(const std::string& names) {
  std::vector<std::string> parts = io::split_text(names, ',');
  parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
  return parts;
}

bool yields(const Announcement& own, const Announcement& other) {
  if (own.is_established != other.is_established) return other.is_established;
  return std::tie(other.since_ns, other.host, other.pid) < std::tie(own.since_ns, own.host, own.pid);
}

}  // namespace swiftlet::rtps
