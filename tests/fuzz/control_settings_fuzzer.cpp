// Fuzzes control settings files.
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tests::is_read([&] {
    const control::ControlSettings settings =
        io::parse_control_settings(tests::text_of(data, size), tests::kFuzzedFile);
    tests::demand(control::validate(settings).empty(), "settings that were read are valid");
  });
  return 0;
}
