// The messages of recorded topics as columns of numbers over time.
//
//   const mcap::Reader file("flight.mcap");
//   const auto series = mcap::read_series(file, {{"/kl1/estimate"}});
//   const std::vector<double>& north = series.at("/kl1/estimate").numbers("position_ned[0]");
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::mcap {

double number_of(const Value& value);  // NaN for a text

// One topic, a row for each message in the order of the log times.
class Series {
 public:
  // file: its name, for errors. columns: of the topic
  Series(std::string file, std::string topic, const std::vector<Column>& columns);

  const std::string& topic() const { return topic_; }
  const std::vector<Column>& columns() const { return columns_; }
  std::size_t size() const { return log_time_ns_.size(); }
  const std::vector<std::int64_t>& log_time_ns() const { return log_time_ns_; }
  const std::vector<std::int64_t>& publish_time_ns() const { return publish_time_ns_; }
  // The messages' own stamps; their log times if the type has no stamp_ns.
  const std::vector<std::int64_t>& stamp_ns() const { return stamp_column_ < 0 ? log_time_ns_ : stamp_ns_; }

  // The columns, named as `swiftlet log ls FILE TOPIC` prints them: "position_ned[0]".
  std::vector<std::string> number_names() const;
  bool has_numbers(const std::string& column) const;
  // One value a row. All throw ConfigError with file and topic if there is no such column.
  const std::vector<double>& numbers(const std::string& column) const;
  const std::vector<std::uint64_t>& integers(
      const std::string& column) const;  // unsigned ones, exact: identifiers
  const std::vector<std::string>& texts(const std::string& column) const;

  // Null if there is no such column. Throw ConfigError if it is of another kind.
  const std::vector<double>* find_numbers(const std::string& column) const;
  const std::vector<std::string>* find_texts(const std::string& column) const;

  // Before the first row.
  void keep_only(const std::function<bool(const Column&)>& keeps);
  void reserve(std::size_t rows);
  void append(const Message& message, const std::vector<Value>& values);

 private:
  // Throws ConfigError if the column is of another kind.
  bool has_as(const std::string& column, bool (*fits)(Column::Kind), const char* what) const;
  // Throws ConfigError if there is no such column.
  std::size_t index_of(const std::string& column, bool (*fits)(Column::Kind), const char* what) const;

  std::string file_;
  std::string topic_;
  std::vector<Column> columns_;
  std::vector<char> kept_;  // by column: whether its values are kept
  int stamp_column_ = -1;
  std::vector<std::int64_t> log_time_ns_;
  std::vector<std::int64_t> publish_time_ns_;
  std::vector<std::int64_t> stamp_ns_;
  // By column; empty for one of another kind.
  std::vector<std::vector<double>> numbers_;
  std::vector<std::vector<std::uint64_t>> integers_;
  std::vector<std::vector<std::string>> texts_;
};

// Reads the selected topics in one pass, without topics all that can be decoded. keeps: the columns to keep; of the others the
// series have no values; empty: all. Throws ConfigError as TopicDecoder does.
std::map<std::string, Series> read_series(const Reader& file, const Selection& selection,
                                          const std::function<bool(const Column&)>& keeps = {});

}  // namespace swiftlet::mcap
