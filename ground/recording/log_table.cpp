#include "swiftlet/ground/recording/log_table.hpp"

#include <limits>
#include <map>
#include <set>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::ground {
namespace {

std::string listed(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

// The decoders of a topic's channels. Two recorders may have given it one each.
std::map<std::uint16_t, mcap::MessageDecoder> decoders_of(const mcap::Reader& file,
                                                          const std::string& topic) {
  std::map<std::uint16_t, mcap::MessageDecoder> decoders;
  std::set<std::string> topics;
  for (const auto& [id, channel] : file.channels()) {
    topics.insert(channel.topic);
    if (channel.topic != topic) continue;
    const mcap::Schema* const schema = file.schema_of(channel);
    if (schema == nullptr || channel.message_encoding != "cdr" || schema->encoding != "ros2msg") {
      throw runtime::ConfigError(file.name(), 0, topic,
                                 "is encoded as '" + channel.message_encoding + "' with a schema '" +
                                     (schema == nullptr ? "" : schema->encoding) +
                                     "', must be cdr and ros2msg");
    }
    decoders.emplace(id, mcap::MessageDecoder(*schema));
  }
  if (decoders.empty())
    throw runtime::ConfigError(file.name(), 0, topic, "is not in the file, which has " + listed(topics));
  return decoders;
}

}  // namespace

std::vector<std::string> decodable_topics(const mcap::Reader& file) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : file.channels()) {
    const mcap::Schema* const schema = file.schema_of(channel);
    if (schema != nullptr && channel.message_encoding == "cdr" && schema->encoding == "ros2msg")
      topics.insert(channel.topic);
  }
  return {topics.begin(), topics.end()};
}

void for_each_row(const mcap::Reader& file, const mcap::Selection& selection, const std::string& topic,
                  const UseRow& use) {
  const auto decoders = decoders_of(file, topic);
  const std::size_t columns = decoders.begin()->second.columns().size();
  mcap::Selection selected = selection;
  selected.topics = {topic};
  mcap::Messages messages(file, selected);
  std::vector<mcap::Value> values;
  std::size_t number = 0;
  while (messages.next()) {
    ++number;
    const mcap::Message& message = messages.message();
    if (!decoders.at(message.channel_id).decode(message.payload, values) || values.size() != columns)
      throw runtime::ConfigError(file.name(), 0, topic,
                                 "message " + std::to_string(number) + " does not fit its schema");
    use(message, values);
  }
}

std::vector<mcap::Column> columns_of(const mcap::Reader& file, const std::string& topic) {
  return decoders_of(file, topic).begin()->second.columns();
}

double number_of(const mcap::Value& value) {
  if (const auto* const number = std::get_if<double>(&value)) return *number;
  if (const auto* const number = std::get_if<std::int64_t>(&value)) return static_cast<double>(*number);
  if (const auto* const number = std::get_if<std::uint64_t>(&value)) return static_cast<double>(*number);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace swiftlet::ground
