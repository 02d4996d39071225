#include "swiftlet/ground/pages/recorded/topic_table.hpp"

#include <algorithm>
#include <limits>

#include "swiftlet/ground/recording/log_table.hpp"

namespace swiftlet::pages {
namespace {

constexpr const char* kStamp = "stamp_ns";
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool is_wanted(const std::string& column, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), column.substr(0, column.find('['))) != names.end();
}

std::int64_t integer_of(const mcap::Value& value) {
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return *number;
  return static_cast<std::int64_t>(ground::number_of(value));
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
                      const std::vector<std::string>& names) {
  TopicTable table;
  const std::vector<std::string> topics = ground::decodable_topics(file);
  if (!std::binary_search(topics.begin(), topics.end(), topic)) return table;
  const std::vector<mcap::Column> columns = ground::columns_of(file, topic);
  std::size_t stamp = kNone;
  std::vector<std::pair<std::size_t, std::vector<double>*>> numbers;
  std::vector<std::pair<std::size_t, std::vector<std::string>*>> texts;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].name == kStamp) stamp = i;
    if (!is_wanted(columns[i].name, names)) continue;
    if (columns[i].kind == mcap::Column::Kind::kText) {
      texts.emplace_back(i, &table.texts[columns[i].name]);
    } else {
      numbers.emplace_back(i, &table.numbers[columns[i].name]);
    }
  }
  ground::for_each_row(
      file, {}, topic, [&](const mcap::Message& message, const std::vector<mcap::Value>& values) {
        const std::int64_t time_ns = stamp == kNone ? message.log_time_ns : integer_of(values[stamp]);
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
