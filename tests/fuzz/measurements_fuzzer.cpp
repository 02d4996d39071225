// Fuzzes CSV files of a test bench.
#include <cmath>

#include "swiftlet/io/measurements.hpp"
#include "tests/fuzz/refusal.hpp"

using namespace swiftlet;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using Q = io::Quantity;
  tests::is_read([&] {
    const io::Measurements measurements =
        io::parse_measurements(tests::text_of(data, size), tests::kFuzzedFile,
                               {Q::kTime, Q::kSupplyVoltage, Q::kMotorVoltage, Q::kThrottle, Q::kPulseWidth,
                                Q::kSpeed, Q::kThrust, Q::kTorque});
    for (const Q quantity : {Q::kTime, Q::kSpeed, Q::kThrust}) {
      if (!measurements.has(quantity)) continue;
      const std::vector<double>& column = measurements.column(quantity);
      tests::demand(column.size() == measurements.row_count(), "a column has all rows");
      for (const double value : column) tests::demand(std::isfinite(value), "a reading is finite");
    }
  });
  return 0;
}
