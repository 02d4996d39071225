#include "swiftlet/analysis/pages/flight_page.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/pages/assets.hpp"
#include "swiftlet/analysis/pages/html.hpp"
#include "swiftlet/analysis/pages/packed_column.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::pages {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kControls = R"(<div class="controls">
<button type="button" id="play">Play</button>
<input type="range" id="time" aria-label="time, s">
<output id="time-text" for="time"></output>
<span class="group" role="group" aria-label="range of time">
<button type="button" id="earlier" aria-label="earlier">◀</button>
<button type="button" id="zoom-out" aria-label="zoom out">−</button>
<button type="button" id="zoom-in" aria-label="zoom in">+</button>
<button type="button" id="later" aria-label="later">▶</button>
<button type="button" id="whole">Whole flight</button>
</span>
<button type="button" id="home">Reset view</button>
</div>
)";

constexpr const char* kHint =
    "Drag in a chart to zoom all charts, with "
    "Shift to move, double-click for the whole flight. "
    "Drag in the picture to turn it, Ctrl and wheel to zoom. Dashed lines are references, dotted ones bounds "
    "and limits; "
    "the grey path is the reference, the coloured rotors are the front ones, and the vehicle is drawn larger "
    "than it is.";

// The columns of all flights, as elements of the page.
class Columns {
 public:
  std::string add(const std::string& text) {
    const std::string id = "c" + std::to_string(count_++);
    elements_ += data_element(id, text);
    return id;
  }
  const std::string& elements() const { return elements_; }

 private:
  std::size_t count_ = 0;
  std::string elements_;
};

Json fence_of(const FlightLog& flight) {
  if (!flight.fence) return nullptr;
  return {{"min", flight.fence->min_ned}, {"max", flight.fence->max_ned}};
}

Json json_of(const FlightLog& flight, Columns& columns) {
  Json tables = Json::object();
  for (const auto& [name, table] : flight.tables) {
    if (table.time_s.empty()) continue;
    Json signals = Json::object();
    for (const auto& [signal, values] : table.signals) signals[signal] = columns.add(packed(values));
    tables[name] = {{"start", flight.start_s},
                    {"time", columns.add(packed_times(table.time_s, flight.start_s))},
                    {"signals", std::move(signals)}};
  }
  Json modes = Json::array();
  for (const ModeChange& change : flight.modes) modes.push_back({change.time_s, change.mode});
  Json events = Json::array();
  for (const FlightEvent& event : flight.events)
    events.push_back({event.time_s, event.kind, event.text, event.warning});
  return {{"name", flight.name},        {"start", flight.start_s},     {"end", flight.end_s},
          {"fence", fence_of(flight)},  {"tables", std::move(tables)}, {"modes", std::move(modes)},
          {"events", std::move(events)}};
}

std::string summary_table(const std::vector<FlightLog>& flights) {
  Row head = {"flight"};
  Row labels;
  for (const FlightLog& flight : flights) {
    head.push_back(flight.name);
    for (const auto& [label, value] : flight.summary) {
      if (std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
    }
  }
  std::vector<Row> rows;
  for (const std::string& label : labels) {
    Row row = {label};
    for (const FlightLog& flight : flights) {
      const auto found = std::find_if(flight.summary.begin(), flight.summary.end(),
                                      [&](const auto& entry) { return entry.first == label; });
      row.push_back(found == flight.summary.end() ? "–" : found->second);
    }
    rows.push_back(std::move(row));
  }
  return table(head, rows);
}

std::string event_table(const std::vector<FlightLog>& flights) {
  struct Line {
    const FlightLog* flight;
    const FlightEvent* event;
  };
  std::vector<Line> lines;
  for (const FlightLog& flight : flights) {
    for (const FlightEvent& event : flight.events) lines.push_back({&flight, &event});
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Line& a, const Line& b) { return a.event->time_s < b.event->time_s; });
  std::string out =
      "<div id=\"events\" tabindex=\"0\" role=\"region\" aria-label=\"events\"><table><tr><th>time, s</th>";
  if (flights.size() > 1) out += "<th>flight</th>";
  out += "<th>kind</th><th>event</th></tr>\n";
  for (const auto& [flight, event] : lines) {
    out += fmt::format("<tr{}><td data-time=\"{:.6f}\">{:.3f}</td>",
                       event->warning ? " class=\"warning\"" : "", event->time_s, event->time_s);
    if (flights.size() > 1) out += element("td", flight->name);
    out += element("td", event->kind) + element("td", event->text) + "</tr>\n";
  }
  return out + "</table></div>\n";
}

}  // namespace

std::string flight_page(const std::string& title, const std::string& note,
                        const std::vector<FlightLog>& flights) {
  Columns columns;
  Json data = Json::array();
  for (const FlightLog& flight : flights) data.push_back(json_of(flight, columns));
  // In a script element only '<' could end the text.
  const std::string json = boost::algorithm::replace_all_copy(io::json_text(data), "<", "\\u003c");
  const std::string body = element("h1", title) + "\n<div class=\"top\">" + summary_table(flights) +
                           "<div id=\"scene\"></div></div>\n" + kControls +
                           "<div id=\"timeline\"></div>\n<p class=\"quiet\">" + escaped(note) + " " + kHint +
                           "</p>\n<div id=\"charts\"></div>\n" + element("h2", "Events") +
                           event_table(flights) + data_element("flights", json) + columns.elements();
  return document(title, body, {chart_scripts(), scene_scripts(), flight_scripts()});
}

}  // namespace swiftlet::pages
