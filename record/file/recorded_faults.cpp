#include "swiftlet/record/file/recorded_faults.hpp"

#include <algorithm>
#include <optional>

#include <fmt/core.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/mcap/attached_file.hpp"

namespace swiftlet::record {

std::vector<FaultRow> fault_rows(const plant::SimulationSettings& settings) {
  std::vector<FaultRow> rows;
  for (const plant::Fault& fault : settings.faults) {
    rows.push_back(
        {math::nanoseconds(fault.at_s), math::nanoseconds(fault.at_s + fault.for_s),
         fmt::format("{}, at_s {:g}, for_s {:g}", to_string(fault.kind), fault.at_s, fault.for_s)});
  }
  std::stable_sort(rows.begin(), rows.end(),
                   [](const FaultRow& a, const FaultRow& b) { return a.from_ns < b.from_ns; });
  return rows;
}

std::vector<FaultRow> recorded_faults(const mcap::Reader& file, const std::string& vehicle) {
  const std::string name = "simulation.yaml";
  const std::optional<std::string> settings = mcap::attached_file(file, vehicle, name);
  if (!settings) return {};
  try {
    return fault_rows(io::parse_simulation_settings(*settings, name));
  } catch (const io::ConfigError&) {
    return {};
  }
}

ProcessLogLine log_line(const FaultRow& fault) {
  return {fault.from_ns, "plant", "warning", "fault: " + fault.text};
}

}  // namespace swiftlet::record
