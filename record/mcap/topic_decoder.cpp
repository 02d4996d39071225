#include "swiftlet/record/mcap/topic_decoder.hpp"

#include <set>
#include <utility>

#include "swiftlet/io/config_error.hpp"

namespace swiftlet::mcap {
namespace {

std::string listed(const std::set<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

}  // namespace

bool is_decodable(const Reader& file, const Channel& channel) {
  const Schema* const schema = file.schema_of(channel);
  return schema != nullptr && channel.message_encoding == "cdr" && schema->encoding == "ros2msg";
}

std::vector<std::string> decodable_topics(const Reader& file) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : file.channels()) {
    if (is_decodable(file, channel)) topics.insert(channel.topic);
  }
  return {topics.begin(), topics.end()};
}

TopicDecoder::TopicDecoder(const Reader& file, std::string topic)
    : file_(file.name()), topic_(std::move(topic)) {
  std::set<std::string> topics;
  for (const auto& [id, channel] : file.channels()) {
    topics.insert(channel.topic);
    if (channel.topic != topic_) continue;
    const Schema* const schema = file.schema_of(channel);
    if (!is_decodable(file, channel)) {
      throw io::ConfigError(file_, 0, topic_,
                            "is encoded as '" + channel.message_encoding + "' with a schema '" +
                                (schema == nullptr ? "" : schema->encoding) + "', must be cdr and ros2msg");
    }
    const MessageDecoder& decoder = decoders_.emplace(id, MessageDecoder(*schema)).first->second;
    if (!(decoder.columns() == columns()))
      throw io::ConfigError(file_, 0, topic_, "was recorded with types that differ");
  }
  if (decoders_.empty())
    throw io::ConfigError(file_, 0, topic_, "is not in the file, which has " + listed(topics));
}

void TopicDecoder::decode(const Message& message, std::vector<Value>& values) {
  ++decoded_;
  if (!decoders_.at(message.channel_id).decode(message.payload, values) || values.size() != columns().size())
    throw io::ConfigError(file_, 0, topic_,
                          "message " + std::to_string(decoded_) + " does not fit its schema");
}

}  // namespace swiftlet::mcap
