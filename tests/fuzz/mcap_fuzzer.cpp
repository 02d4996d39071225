// Fuzzes MCAP files, and the definitions and messages in them.
#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/record/mcap/reader.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

namespace {

// Decodes the message by the schema of its channel, if that is understood.
void decode(const mcap::Reader& file, const mcap::Channel& channel, const mcap::Message& message) {
  const mcap::Schema* const schema = file.schema_of(channel);
  if (schema == nullptr) return;
  try {
    const mcap::MessageDecoder decoder(*schema);
    std::vector<mcap::Value> values;
    if (decoder.decode(message.payload, values))
      tests::demand(values.size() == decoder.columns().size(), "each column has a value");
  } catch (const io::ConfigError&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const mcap::Access access : {mcap::Access::kIndexed, mcap::Access::kScanned}) {
    tests::is_read([&] {
      const mcap::Reader file({data, size}, tests::kFuzzedFile, access);
      for (const mcap::AttachmentIndex& index : file.attachments()) file.attachment(index);
      mcap::Messages messages(file, {});
      std::uint64_t count = 0;
      std::int64_t last_ns = std::numeric_limits<std::int64_t>::min();
      for (; messages.next(); ++count) {
        const mcap::Message& message = messages.message();
        tests::demand(message.log_time_ns >= last_ns || access == mcap::Access::kIndexed,
                      "messages come in order");
        last_ns = message.log_time_ns;
        decode(file, messages.channel(), message);
      }
      tests::demand(access == mcap::Access::kIndexed || count == file.statistics().message_count,
                    "all counted messages are read");
    });
  }
  return 0;
}
