// Decodes the messages of one topic of a file. Two recorders may have given the topic a channel each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::mcap {

// True for message encoding cdr with a schema in ros2msg.
bool is_decodable(const Reader& file, const Channel& channel);

// The topics of a file that can be decoded, sorted.
std::vector<std::string> decodable_topics(const Reader& file);

class TopicDecoder {
 public:
  // Throws ConfigError if the file has no such topic, a channel of it cannot be decoded, or two have other signals.
  TopicDecoder(const Reader& file, std::string topic);

  const std::vector<Column>& columns() const { return decoders_.begin()->second.columns(); }

  // One value for each column. Throws ConfigError if the message does not fit its schema.
  void decode(const Message& message, std::vector<Value>& values);

 private:
  std::string file_;
  std::string topic_;
  std::map<std::uint16_t, MessageDecoder> decoders_;
  std::size_t decoded_ = 0;
};

}  // namespace swiftlet::mcap
