// Fuzzes dispersion files and the samples drawn from them.
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/dispersion_file.hpp"
#include "tests/fuzz/refusal.hpp"
#include "tests/support/paths.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const simulation::World nominal{
      io::load_vehicle(swiftlet::tests::in_source("config/vehicles/kaylion.yaml")),
      io::load_simulation_settings(swiftlet::tests::in_source("config/simulation/default.yaml"))};
  tests::is_read([&] {
    const simulation::Dispersion dispersion = simulation::parse_dispersion_file(
        std::string(tests::text_of(data, size)), tests::kFuzzedFile, nominal);
    const simulation::DispersionSample draw = simulation::draw(dispersion, nominal, 1);
    tests::demand(simulation::validate(draw.world).empty(), "a sampled world is valid");
  });
  return 0;
}
