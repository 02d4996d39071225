#include "swiftlet/recording/flight_window.hpp"

#include <algorithm>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::ground {

std::optional<Window> mission_window(const FlightRecord& record, std::uint64_t mission_id,
                                     const control::Mission& mission) {
  const ReferenceRow* const end = record.reference.end();
  const auto in_mission = [](const ReferenceRow& row) {
    return row.mode == static_cast<int>(control::Mode::kMission);
  };
  const ReferenceRow* const first = std::find_if(record.reference.begin(), end, in_mission);
  if (first == end) return std::nullopt;

  const std::size_t land = mission.items.back().kind == control::MissionItemKind::kLand
                               ? mission.items.size() - 1
                               : mission.items.size();
  for (const MissionRow& row : record.mission) {
    if (row.mission_id != mission_id || row.stamp_ns < first->stamp_ns) continue;
    if (row.item_index >= land) return Window{first->stamp_ns, row.stamp_ns};
  }
  const ReferenceRow* last = end - 1;
  while (last != first && !in_mission(*last)) --last;
  return Window{first->stamp_ns, last->stamp_ns + 1};
}

double mission_duration_s(const FlightRecord& record, std::uint64_t mission_id, Window window) {
  std::int64_t end_ns = record.reference.empty() ? window.to_ns : record.reference.back().stamp_ns;
  for (const MissionRow& row : record.mission) {
    const auto state = static_cast<control::MissionState>(row.state);
    const bool over = state == control::MissionState::kCompleted || state == control::MissionState::kAborted;
    if (row.mission_id != mission_id || !over) continue;
    end_ns = row.stamp_ns;
    break;
  }
  return static_cast<double>(end_ns - window.from_ns) * 1e-9;
}

}  // namespace swiftlet::ground
