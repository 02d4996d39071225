#include "swiftlet/analysis/logs/log_table.hpp"

namespace swiftlet::analysis {

void for_each_row(const mcap::Reader& file, const mcap::Selection& selection, const std::string& topic,
                  const UseRow& use) {
  mcap::TopicDecoder decoder(file, topic);
  mcap::Selection selected = selection;
  selected.topics = {topic};
  mcap::Messages messages(file, selected);
  std::vector<mcap::Value> values;
  while (messages.next()) {
    decoder.decode(messages.message(), values);
    use(messages.message(), values);
  }
}

std::vector<mcap::Column> columns_of(const mcap::Reader& file, const std::string& topic) {
  return mcap::TopicDecoder(file, topic).columns();
}

}  // namespace swiftlet::analysis
