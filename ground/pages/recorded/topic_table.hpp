// The messages of one topic of a recorded flight, column by column.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/io/mcap/reader.hpp"

namespace swiftlet::pages {

// All vectors have an element for each message.
struct TopicTable {
  std::vector<std::int64_t>
      stamp_ns;  // of the vehicle's clock, ascending; of messages without stamp the log time
  std::vector<std::int64_t> publish_ns;
  std::vector<std::int64_t> log_ns;
  std::map<std::string, std::vector<double>> numbers;
  std::map<std::string, std::vector<std::string>> texts;

  std::size_t rows() const { return stamp_ns.size(); }
  // Null if the messages have no such member.
  const std::vector<double>* find(const std::string& name) const;
  // NaN, or an empty text, if the messages have no such member.
  double number(const std::string& name, std::size_t row) const;
  std::string text(const std::string& name, std::size_t row) const;
};

// number_names, text_names: of the members to read, of arrays without index. The table is empty if the file has no such topic.
// Messages older than one before them are left out. Throws ConfigError for a damaged file, or if a member is of another type.
TopicTable read_topic(const mcap::Reader& file, const std::string& topic,
                      const std::vector<std::string>& number_names,
                      const std::vector<std::string>& text_names = {});

}  // namespace swiftlet::pages
