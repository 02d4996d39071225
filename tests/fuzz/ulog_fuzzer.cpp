// Fuzzes logs of PX4: every topic and field that a file names is read.
#include "swiftlet/io/ulog/ulog.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  tests::is_read([&] {
    const ulog::Log log(bytes, tests::kFuzzedFile);
    if (!log.has("motion")) return;
    const ulog::Table table = log.read("motion", {"xyz[2]"});
    tests::demand(table.columns.size() == 1 && table.columns[0].size() == table.rows(),
                  "each row has a value");
    for (std::size_t i = 1; i < table.rows(); ++i)
      tests::demand(table.time_s[i] > table.time_s[i - 1], "time rises");
  });
  return 0;
}
