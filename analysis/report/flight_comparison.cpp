#include "swiftlet/analysis/report/flight_comparison.hpp"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/core.h>

#include "swiftlet/io/json_text.hpp"

namespace swiftlet::analysis {
namespace {

using Row = std::vector<std::string>;  // label, then one cell per flight

constexpr const char* kMissing = "-";

std::string value_of(const RecordedFlight& flight, const std::string& key) {
  const auto found = std::find_if(flight.settings.begin(), flight.settings.end(),
                                  [&](const auto& setting) { return setting.first == key; });
  return found == flight.settings.end() ? kMissing : found->second;
}

// The keys of all flights without repetition, in order of first appearance.
std::vector<std::string> keys_of(const std::vector<RecordedFlight>& flights) {
  std::vector<std::string> keys;
  std::set<std::string> known;
  for (const RecordedFlight& flight : flights) {
    for (const auto& [key, value] : flight.settings) {
      if (known.insert(key).second) keys.push_back(key);
    }
  }
  return keys;
}

std::vector<std::string> differing_keys(const std::vector<RecordedFlight>& flights) {
  std::vector<std::string> keys = keys_of(flights);
  const auto alike = [&](const std::string& key) {
    return std::all_of(flights.begin(), flights.end(), [&](const RecordedFlight& flight) {
      return value_of(flight, key) == value_of(flights.front(), key);
    });
  };
  keys.erase(std::remove_if(keys.begin(), keys.end(), alike), keys.end());
  return keys;
}

std::string millimetres(const nlohmann::ordered_json& report, const char* key) {
  const auto found = report.find(key);
  if (found == report.end() || !found->is_number()) return kMissing;
  return fmt::format("{:.2f}", found->get<double>() * 1e3);
}

std::string text(const nlohmann::ordered_json& report, const char* key) {
  const auto found = report.find(key);
  if (found == report.end()) return kMissing;
  return found->is_string() ? found->get<std::string>() : io::json_text(*found);
}

std::vector<Row> figures(const std::vector<RecordedFlight>& flights) {
  std::vector<Row> rows(9);
  const std::array heads = {"flight", "mission",   "vehicle",     "control",     "level",
                            "seed",   "completed", "RMS 3-D, mm", "peak 3-D, mm"};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].emplace_back(heads[i]);
  for (const RecordedFlight& flight : flights) {
    rows[0].push_back(flight.name);
    rows[1].push_back(text(flight.report, "mission"));
    rows[2].push_back(text(flight.report, "vehicle"));
    rows[3].push_back(text(flight.report, "control"));
    rows[4].push_back(text(flight.report, "level"));
    rows[5].push_back(text(flight.report, "seed"));
    rows[6].push_back(flight.report.value("completed", false) ? "yes" : "NO");
    rows[7].push_back(millimetres(flight.report, "rms_3d_m"));
    rows[8].push_back(millimetres(flight.report, "peak_3d_m"));
  }
  return rows;
}

std::string layout(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string table;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    line.erase(line.find_last_not_of(' ') + 1);
    table += line + "\n";
  }
  return table;
}

std::string failures(const std::vector<RecordedFlight>& flights) {
  std::string lines;
  for (const RecordedFlight& flight : flights) {
    if (flight.report.contains("reason")) lines += flight.name + ": " + text(flight.report, "reason") + "\n";
  }
  return lines;
}

}  // namespace

std::string comparison_table(const std::vector<RecordedFlight>& flights) {
  const std::string table = layout(figures(flights)) + failures(flights);
  if (flights.size() == 1) return table;
  const std::size_t count = differing_keys(flights).size();
  if (count == 0) return table + "\nno settings differ\n";
  return table + fmt::format("\n{} (--settings)\n",
                             count == 1 ? "1 setting differs" : fmt::format("{} settings differ", count));
}

std::string settings_table(const std::vector<RecordedFlight>& flights) {
  std::vector<Row> rows;
  if (flights.size() == 1) {
    for (const auto& [key, value] : flights.front().settings) {
      if (key.rfind("control.", 0) == 0) rows.push_back({key, value});
    }
    return rows.empty() ? "the record contains no settings\n" : layout(rows);
  }
  for (const std::string& key : differing_keys(flights)) {
    Row row{key};
    for (const RecordedFlight& flight : flights) row.push_back(value_of(flight, key));
    rows.push_back(std::move(row));
  }
  return rows.empty() ? "no settings differ\n" : "settings that differ\n" + layout(rows);
}

nlohmann::ordered_json comparison_json(const std::vector<RecordedFlight>& flights) {
  nlohmann::ordered_json json;
  json["flights"] = nlohmann::ordered_json::array();
  for (const RecordedFlight& flight : flights) {
    nlohmann::ordered_json settings = nlohmann::ordered_json::object();
    for (const auto& [key, value] : flight.settings) settings[key] = value;
    json["flights"].push_back(
        {{"folder", flight.record.string()}, {"report", flight.report}, {"settings", std::move(settings)}});
  }
  json["differ"] = differing_keys(flights);
  return json;
}

}  // namespace swiftlet::analysis
