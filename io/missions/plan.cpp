#include "swiftlet/io/missions/plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/io/csv.hpp"

namespace swiftlet::io {
namespace {

constexpr std::string_view kBegin = "QGC WPL ";
const std::vector<std::string> kColumns = {"index", "current", "frame", "command", "p1", "p2",
                                           "p3",    "p4",      "x",     "y",       "z",  "autocontinue"};
constexpr std::size_t kFrame = 2, kCommand = 3, kFirstParameter = 4, kParameters = 7;

// JSON is valid YAML in flow style, and the YAML reader reports lines. nlohmann::json only checks that it is
// JSON.
ConfigNode read_json(std::string text, const std::string& file_name) {
  try {
    [[maybe_unused]] const auto valid = nlohmann::json::parse(text);
  } catch (const nlohmann::json::out_of_range&) {  // such as 1e309; no position given
    throw io::ConfigError(file_name, 0, "", "holds a number beyond 1.8e308, must hold smaller ones");
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t at = std::min(error.byte, text.size());
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
    const auto line = 1 + std::count(text.begin(), end, '\n');
    const std::size_t line_begin = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
    const std::size_t column = line_begin == std::string::npos ? at : at - line_begin - 1;
    throw io::ConfigError(file_name, static_cast<int>(line),
                          "column " + std::to_string(std::max<std::size_t>(column, 1)),
                          text.empty() ? "the file is empty, must be a JSON document" : "is invalid JSON");
  }
  std::replace(text.begin(), text.end(), '\t', ' ');  // tabs separate values in JSON but not in YAML
  if (text.back() != '\n') text += '\n';
  return io::parse_config(text, file_name);
}

PlanPlace place_of(const ConfigNode& node) { return {node.file(), node.line(), node.key()}; }

PlanNumber number_of(const ConfigNode& node) {
  const bool is_null = !node.is_map() && !node.is_list() && !node.is_scalar();
  return {place_of(node), is_null ? std::nullopt : std::optional<double>(node.number())};
}

PlanItem item_of(const ConfigNode& node) {
  if (const ConfigNode type = node.at("type"); type.text() != "SimpleItem")
    type.fail("is " + type.text() + ", must be SimpleItem: draw the pattern as waypoints");
  const PlanPlace place = place_of(node);
  const auto frame = node.find("frame");  // not of all commands
  PlanItem item{place,
                number_of(node.at("command")),
                frame ? number_of(*frame) : PlanNumber{{place.file, place.line, place.key + ".frame"}, {}},
                {}};
  for (const ConfigNode& parameter : node.at("params").items(kParameters, kParameters))
    item.params.push_back(number_of(parameter));
  return item;
}

}  // namespace

void PlanPlace::fail(const std::string& message) const { throw ConfigError(file, line, key, message); }

double PlanNumber::number(const Bounds& bounds) const {
  if (!value) place.fail("is empty, must be a number");
  if (!bounds.contains(*value)) place.fail("is " + exact(*value) + ", must be " + bounds.to_string());
  return *value;
}

int PlanNumber::integer(int most) const {
  if (value && *value >= 0.0 && *value <= most && std::floor(*value) == *value)
    return static_cast<int>(*value);
  place.fail(
      fmt::format("is {}, must be a whole number from 0 to {}", value ? exact(*value) : "empty", most));
}

Plan plan_of_json(const std::string& text, const std::string& file_name) {
  const ConfigNode root = read_json(text, file_name);
  if (const ConfigNode type = root.at("fileType"); type.text() != "Plan")
    type.fail("is " + type.text() + ", must be Plan");
  const ConfigNode mission = root.at("mission");
  const ConfigNode items = mission.at("items");
  Plan plan{place_of(mission), place_of(items), {}, false, {}};
  if (const auto home = mission.find("plannedHomePosition")) {
    const std::vector<ConfigNode> values = home->items(3, 3);
    plan.home = {number_of(values[0]), number_of(values[1]), number_of(values[2])};
  }
  plan.estimates_speed = mission.find("hoverSpeed").has_value();
  for (const ConfigNode& item : items.items(1, control::kMaxMissionItems))
    plan.items.push_back(item_of(item));
  return plan;
}

bool is_waypoint_list(std::string_view text) { return text.substr(0, kBegin.size()) == kBegin; }

Plan plan_of_waypoint_list(const std::string& text, const std::string& file_name) {
  const std::vector<CsvLine> lines = csv_lines(text, file_name);
  if (lines.front().text.find("110") == std::string_view::npos)
    throw ConfigError(file_name, 1, "",
                      "is " + std::string(lines.front().text.substr(0, 40)) + ", must be QGC WPL 110");
  Plan plan{{file_name, 0, ""}, {file_name, 0, ""}, {}, false, {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto& [line, written] = lines[i];
    const std::vector<std::string_view> fields = csv_fields(written, kColumns.size(), ' ');
    require_fields(fields, kColumns, file_name, line);
    std::vector<PlanNumber> row;
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const std::string key = fmt::format("field {}", k + 1);
      row.push_back({{file_name, line, key}, csv_number(fields[k], key, file_name, line)});
    }
    const auto begin = row.begin() + kFirstParameter;
    const bool is_global = row[kFrame].value == 0.0 || row[kFrame].value == 3.0;
    if (i == 1 && is_global && row[kCommand].value == 16.0) {
      plan.home = {row[8], row[9], row[10]};
    } else {
      plan.items.push_back({{file_name, line, ""}, row[kCommand], row[kFrame], {begin, begin + kParameters}});
    }
  }
  if (plan.items.empty() || plan.items.size() > control::kMaxMissionItems)
    plan.place.fail(
        fmt::format("has {} items, must have 1 to {}", plan.items.size(), control::kMaxMissionItems));
  return plan;
}

}  // namespace swiftlet::io
