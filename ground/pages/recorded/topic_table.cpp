#include "swiftlet/ground/pages/recorded/topic_table.hpp"

#include <algorithm>
#include <limits>

#include "swiftlet/ground/recording/log_table.hpp"
#include "swiftlet/io/config_error.hpp"

namespace swiftlet::pages {
namespace {

constexpr const char* kStamp = "stamp_ns";
constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

using Kind = mcap::Column::Kind;

// The member of a column: "position_ned" of "position_ned[0]", "items" of "items.length".
std::string member_of(const std::string& column) { return column.substr(0, column.find_first_of("[.")); }

bool is_one_of(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

const char* type_of(const mcap::Column& column) {
  if (column.name.find('.') != std::string::npos)
    return column.name == member_of(column.name) + ".length" ? "a sequence" : "a message";
  return column.kind == Kind::kText ? "a text" : "a number";
}

std::int64_t integer_of(const mcap::Value& value) {
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return *number;
  return static_cast<std::int64_t>(std::get<std::uint64_t>(value));
}

}  // namespace

const std::vector<double>* TopicTable::find(const std::string& name) const {
  const auto found = numbers.find(name);
  return found == numbers.end() ? nullptr : &found->second;
}

double TopicTable::number(const std::string& name, std::size_t row) const {
  const std::vector<double>* const column = find(name);
  return column == nullptr ? std::numeric_limits<double>::quiet_NaN() : (*column)[row];
}

std::string TopicTable::text(const std::string& name, std::size_t row) const {
  const auto found = texts.find(name);
  return found == texts.end() ? "" : found->second[row];
}

TopicTable read_topic(const mcap::Reader& file, const std::string& topic,
                      const std::vector<std::string>& number_names,
                      const std::vector<std::string>& text_names) {
  TopicTable table;
  const std::vector<std::string> topics = ground::decodable_topics(file);
  if (!std::binary_search(topics.begin(), topics.end(), topic)) return table;
  const std::vector<mcap::Column> columns = ground::columns_of(file, topic);
  std::size_t stamp = kNoColumn;
  std::vector<std::pair<std::size_t, std::vector<double>*>> numbers;
  std::vector<std::pair<std::size_t, std::vector<std::string>*>> texts;
  const auto require = [&](bool fits, const mcap::Column& column, const char* what) {
    if (!fits)
      throw runtime::ConfigError(file.name(), 0, topic,
                                 member_of(column.name) + " is " + type_of(column) + ", must be " + what);
  };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const mcap::Column& column = columns[i];
    const std::string member = member_of(column.name);
    const bool is_plain = column.name.find('.') == std::string::npos;
    if (member == kStamp) {
      require(is_plain && (column.kind == Kind::kSigned || column.kind == Kind::kUnsigned), column,
              "an integer");
      stamp = i;
    } else if (is_one_of(member, number_names)) {
      require(is_plain && column.kind != Kind::kText, column, "a number");
      numbers.emplace_back(i, &table.numbers[column.name]);
    } else if (is_one_of(member, text_names)) {
      require(is_plain && column.kind == Kind::kText, column, "a text");
      texts.emplace_back(i, &table.texts[column.name]);
    }
  }
  ground::for_each_row(
      file, {}, topic, [&](const mcap::Message& message, const std::vector<mcap::Value>& values) {
        const std::int64_t time_ns = stamp == kNoColumn ? message.log_time_ns : integer_of(values[stamp]);
        if (!table.stamp_ns.empty() && time_ns < table.stamp_ns.back()) return;
        table.stamp_ns.push_back(time_ns);
        table.publish_ns.push_back(message.publish_time_ns);
        table.log_ns.push_back(message.log_time_ns);
        for (const auto& [i, column] : numbers) column->push_back(ground::number_of(values[i]));
        for (const auto& [i, column] : texts) column->push_back(std::get<std::string>(values[i]));
      });
  return table;
}

}  // namespace swiftlet::pages
