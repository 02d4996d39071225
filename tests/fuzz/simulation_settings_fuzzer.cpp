// Fuzzes simulation settings files.
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tests::is_read([&] {
    const plant::SimulationSettings settings =
        io::parse_simulation_settings(tests::text_of(data, size), tests::kFuzzedFile);
    tests::demand(plant::validate(settings).empty(), "settings that were read are valid");
  });
  return 0;
}
