// Fuzzes MCAP files.
#include "swiftlet/io/mcap/reader.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

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
        file.schema_of(messages.channel());
      }
      tests::demand(access == mcap::Access::kIndexed || count == file.statistics().message_count,
                    "all counted messages are read");
    });
  }
  return 0;
}
