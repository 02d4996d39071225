#include "swiftlet/record/mcap/series.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"

namespace swiftlet::mcap {
namespace {

bool is_text(Column::Kind kind) { return kind == Column::Kind::kText; }
bool is_number(Column::Kind kind) { return kind != Column::Kind::kText; }
bool is_unsigned(Column::Kind kind) { return kind == Column::Kind::kUnsigned; }

}  // namespace

double number_of(const Value& value) {
  if (const auto* const number = std::get_if<double>(&value)) return *number;
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  if (const auto* const number = std::get_if<std::uint64_t>(&value)) return static_cast<double>(*number);
  return std::numeric_limits<double>::quiet_NaN();
}

Series::Series(std::string file, std::string topic, const std::vector<Column>& columns)
    : file_(std::move(file)),
      topic_(std::move(topic)),
      columns_(columns),
      kept_(columns.size(), 1),
      numbers_(columns.size()),
      integers_(columns.size()),
      texts_(columns.size()) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].name == "stamp_ns" && columns_[i].kind == Column::Kind::kSigned)
      stamp_column_ = static_cast<int>(i);
  }
}

void Series::keep_only(const std::function<bool(const Column&)>& keeps) {
  for (std::size_t i = 0; i < columns_.size(); ++i) kept_[i] = keeps(columns_[i]) ? 1 : 0;
}

void Series::reserve(std::size_t rows) {
  log_time_ns_.reserve(rows);
  publish_time_ns_.reserve(rows);
  if (stamp_column_ >= 0) stamp_ns_.reserve(rows);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (kept_[i] == 0) continue;
    if (is_number(columns_[i].kind)) numbers_[i].reserve(rows);
    if (is_unsigned(columns_[i].kind)) integers_[i].reserve(rows);
  }
}

void Series::append(const Message& message, const std::vector<Value>& values) {
  log_time_ns_.push_back(message.log_time_ns);
  publish_time_ns_.push_back(message.publish_time_ns);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (kept_[i] == 0) continue;
    if (const auto* const text = std::get_if<std::string>(&values[i])) {
      texts_[i].push_back(*text);
    } else {
      numbers_[i].push_back(number_of(values[i]));
      if (const auto* const integer = std::get_if<std::uint64_t>(&values[i]))
        integers_[i].push_back(*integer);
    }
  }
  if (stamp_column_ >= 0)
    stamp_ns_.push_back(std::get<std::int64_t>(values[static_cast<std::size_t>(stamp_column_)]));
}

std::vector<std::string> Series::number_names() const {
  std::vector<std::string> names;
  for (const Column& column : columns_) {
    if (is_number(column.kind)) names.push_back(column.name);
  }
  return names;
}

bool Series::has_numbers(const std::string& column) const {
  return std::any_of(columns_.begin(), columns_.end(),
                     [&](const Column& one) { return one.name == column && is_number(one.kind); });
}

std::size_t Series::index_of(const std::string& column, bool (*fits)(Column::Kind), const char* what) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(),
                                  [&](const Column& one) { return one.name == column && fits(one.kind); });
  if (found == columns_.end())
    throw io::ConfigError(file_, 0, topic_, std::string("has no ") + what + " " + column);
  return static_cast<std::size_t>(found - columns_.begin());
}

const std::vector<double>& Series::numbers(const std::string& column) const {
  return numbers_[index_of(column, is_number, "signal")];
}

const std::vector<std::uint64_t>& Series::integers(const std::string& column) const {
  return integers_[index_of(column, is_unsigned, "unsigned integer")];
}

const std::vector<std::string>& Series::texts(const std::string& column) const {
  return texts_[index_of(column, is_text, "text")];
}

bool Series::has_as(const std::string& column, bool (*fits)(Column::Kind), const char* what) const {
  const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const Column& one) {
    return one.name == column || one.name == column + ".length";
  });
  if (found == columns_.end()) return false;
  if (found->name == column && fits(found->kind)) return true;
  const char* const is = found->name != column ? "a sequence" : is_text(found->kind) ? "a text" : "a number";
  throw io::ConfigError(file_, 0, topic_, column + " is " + is + ", must be " + what);
}

const std::vector<double>* Series::find_numbers(const std::string& column) const {
  return has_as(column, is_number, "a number") ? &numbers(column) : nullptr;
}

const std::vector<std::string>* Series::find_texts(const std::string& column) const {
  return has_as(column, is_text, "a text") ? &texts(column) : nullptr;
}

namespace {

std::size_t messages_of(const Reader& file, const std::string& topic) {
  std::size_t sum = 0;
  for (const auto& [id, count] : file.statistics().messages_by_channel) {
    if (file.channels().at(id).topic == topic) sum += count;
  }
  return sum;
}

}  // namespace

std::map<std::string, Series> read_series(const Reader& file, const Selection& selection,
                                          const std::function<bool(const Column&)>& keeps) {
  Selection selected = selection;
  if (selected.topics.empty()) {
    const std::vector<std::string> all = decodable_topics(file);
    selected.topics = {all.begin(), all.end()};
  }
  std::map<std::string, TopicDecoder> decoders;
  std::map<std::string, Series> series;
  for (const std::string& topic : selected.topics) {
    const TopicDecoder& decoder = decoders.try_emplace(topic, file, topic).first->second;
    Series& one = series.try_emplace(topic, file.name(), topic, decoder.columns()).first->second;
    if (keeps) one.keep_only(keeps);
    one.reserve(messages_of(file, topic));
  }
  std::map<std::uint16_t, std::pair<TopicDecoder*, Series*>> of_channel;
  for (const auto& [id, channel] : file.channels()) {
    if (const auto found = decoders.find(channel.topic); found != decoders.end())
      of_channel[id] = {&found->second, &series.at(channel.topic)};
  }
  Messages messages(file, selected);
  std::vector<Value> values;
  while (messages.next()) {
    const Message& message = messages.message();
    const auto& [decoder, one] = of_channel.at(message.channel_id);
    decoder->decode(message, values);
    one->append(message, values);
  }
  return series;
}

}  // namespace swiftlet::mcap
