#include "swiftlet/record/mcap/merge.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace swiftlet::mcap {
namespace {

using Texts = std::map<std::string, std::string>;

// The channels of the written file by what they are.
class Definitions {
 public:
  explicit Definitions(Writer& out) : out_(out) {}

  std::uint16_t channel(const Reader& file, const Channel& channel) {
    const Schema* const schema = file.schema_of(channel);
    const std::uint16_t schema_id = schema == nullptr ? std::uint16_t{0} : schema_id_of(*schema);
    const auto key = std::tuple(channel.topic, schema_id, channel.message_encoding, channel.metadata);
    const auto known = channels_.find(key);
    if (known != channels_.end()) return known->second;
    return channels_[key] =
               out_.add_channel(channel.topic, schema_id, channel.message_encoding, channel.metadata);
  }

 private:
  std::uint16_t schema_id_of(const Schema& schema) {
    const auto key = std::tuple(schema.name, schema.encoding, schema.data);
    const auto known = schemas_.find(key);
    if (known != schemas_.end()) return known->second;
    return schemas_[key] = out_.add_schema(schema.name, schema.encoding, schema.data);
  }

  Writer& out_;
  std::map<std::tuple<std::string, std::string, std::string>, std::uint16_t> schemas_;
  std::map<std::tuple<std::string, std::uint16_t, std::string, Texts>, std::uint16_t> channels_;
};

// A file with its next message.
struct Source {
  const Reader* file;
  Messages messages;
  std::map<std::uint16_t, std::uint16_t> channels{};  // to those of the written file
};

}  // namespace

void merge(const std::vector<const Reader*>& files, const Selection& selection, Writer& out) {
  Definitions definitions(out);
  std::vector<Source> sources;
  for (const Reader* const file : files) {
    for (const Metadata& metadata : file->metadata()) out.write(metadata);
    for (const AttachmentIndex& index : file->attachments()) out.write(file->attachment(index));
    Source source{file, Messages(*file, selection)};
    for (const auto& [id, channel] : file->channels()) {
      if (selection.topics.empty() || selection.topics.count(channel.topic) != 0)
        source.channels[id] = definitions.channel(*file, channel);
    }
    if (source.messages.next()) sources.push_back(std::move(source));
  }
  // Few files: the earliest is sought again for each message.
  const auto earlier = [](const Source& a, const Source& b) {
    return a.messages.message().log_time_ns < b.messages.message().log_time_ns;
  };
  while (!sources.empty()) {
    const auto source = std::min_element(sources.begin(), sources.end(), earlier);
    Message message = source->messages.message();
    message.channel_id = source->channels.at(message.channel_id);
    out.write(message);
    if (!source->messages.next()) {
      // Sources hold references and are not assigned: keep the others in order.
      std::vector<Source> rest;
      for (auto other = sources.begin(); other != sources.end(); ++other) {
        if (other != source) rest.push_back(std::move(*other));
      }
      sources = std::move(rest);
    }
  }
}

}  // namespace swiftlet::mcap
