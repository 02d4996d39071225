#include "swiftlet/services/dds/discovery/announcement.hpp"

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "swiftlet/services/runtime/split_text.hpp"

namespace swiftlet::comms {
namespace {

std::string value_of(const std::string& text, const std::string& key) {
  const std::string begin_of_entry = ";" + key + "=";
  const std::string entries = ";" + text;
  const auto found = entries.find(begin_of_entry);
  if (found == std::string::npos) return {};
  const auto begin = found + begin_of_entry.size();
  return entries.substr(begin, entries.find(';', begin) - begin);
}

}  // namespace

std::vector<std::uint8_t> to_user_data(const Announcement& announcement) {
  std::string text = "enclave=/;vehicle=" + announcement.vehicles + ";host=" + announcement.host +
                     ";process=" + std::to_string(announcement.pid) + ";";
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
  announcement.pid = std::atoi(value_of(text, "process").c_str());
  announcement.source_of = value_of(text, "source_of");
  announcement.since_ns = std::strtoll(value_of(text, "since").c_str(), nullptr, 10);
  announcement.is_established = value_of(text, "established") == "1";
  return announcement;
}

bool lists(const std::string& names, const std::string& name) {
  return ("," + names + ",").find("," + name + ",") != std::string::npos;
}

std::vector<std::string> split_names(const std::string& names) {
  std::vector<std::string> parts = runtime::split_text(names, ',');
  parts.erase(std::remove(parts.begin(), parts.end(), ""), parts.end());
  return parts;
}

std::string join_names(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
  return list;
}

bool yields(const Announcement& own, const Announcement& other) {
  if (own.is_established != other.is_established) return other.is_established;
  return std::tie(other.since_ns, other.host, other.pid) < std::tie(own.since_ns, own.host, own.pid);
}

}  // namespace swiftlet::comms
