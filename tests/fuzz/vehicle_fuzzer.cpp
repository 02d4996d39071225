// Fuzzes reading and writing of vehicle files.
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/settings/vehicle_writer.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

namespace {

std::string rewritten(std::string_view text, const plant::Vehicle& vehicle) {
  return io::vehicle_text(vehicle, io::parse_vehicle_sources(text, tests::kFuzzedFile),
                          io::parse_vehicle_uncertainty(text, tests::kFuzzedFile), "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = tests::text_of(data, size);
  tests::is_read([&] {
    const plant::Vehicle vehicle = io::parse_vehicle(text, tests::kFuzzedFile);
    tests::demand(plant::validate(vehicle).empty(), "a vehicle that was read is valid");
    const std::string once = rewritten(text, vehicle);
    std::string twice;
    tests::demand(
        tests::is_read([&] { twice = rewritten(once, io::parse_vehicle(once, tests::kFuzzedFile)); }),
        "a written vehicle can be read");
    tests::demand(once == twice, "a written vehicle is read unchanged");
  });
  return 0;
}
