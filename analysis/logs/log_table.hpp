// The messages of one topic of a recorded file as a table.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/record/mcap/reader.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"

namespace swiftlet::analysis {

using mcap::decodable_topics;
using mcap::number_of;

// Calls use(message, values) for each message of the topic in order, with a value for each of its columns.
// Throws ConfigError as mcap::TopicDecoder does.
using UseRow = std::function<void(const mcap::Message&, const std::vector<mcap::Value>&)>;
void for_each_row(const mcap::Reader& file, const mcap::Selection& selection, const std::string& topic,
                  const UseRow& use);

// The columns of a topic. Throws ConfigError as above.
std::vector<mcap::Column> columns_of(const mcap::Reader& file, const std::string& topic);

}  // namespace swiftlet::analysis
