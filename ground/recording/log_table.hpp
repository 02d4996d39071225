// The messages of one topic of a recorded file as a table.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "swiftlet/io/mcap/message_decoder.hpp"
#include "swiftlet/io/mcap/reader.hpp"

namespace swiftlet::ground {

// The topics of a file that can be decoded, sorted.
std::vector<std::string> decodable_topics(const mcap::Reader& file);

// Calls use(message, values) for each message of the topic in order, with a value for each of its columns.
// Throws ConfigError if the file has no such topic, a channel cannot be decoded, or a message does not fit its schema.
using UseRow = std::function<void(const mcap::Message&, const std::vector<mcap::Value>&)>;
void for_each_row(const mcap::Reader& file, const mcap::Selection& selection, const std::string& topic,
                  const UseRow& use);

// The columns of a topic. Throws ConfigError as above.
std::vector<mcap::Column> columns_of(const mcap::Reader& file, const std::string& topic);

double number_of(const mcap::Value& value);  // NaN for a text

}  // namespace swiftlet::ground
