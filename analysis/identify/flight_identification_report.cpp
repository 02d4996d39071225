#include "swiftlet/analysis/identify/flight_identification_report.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/identify/report_page.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::analysis {
namespace {

using identification::FileComparison;
using identification::FlightIdentification;
using identification::HorizonError;
using identification::ParameterEstimate;
using identification::PredictionError;
using identification::SpeedSource;
using plot::Colour;
using plot::Style;
using Json = nlohmann::ordered_json;

constexpr double kShownS = 8.0;  // s, length of the figures of predictions
constexpr int kHeight = 300;     // px, of the figures

const char* source_text(SpeedSource source) {
  switch (source) {
    case SpeedSource::kMeasured:
      return "measured rotor speeds";
    case SpeedSource::kModelled:
      return "rotor speeds modelled from command and supply voltage";
    case SpeedSource::kCommanded:
      break;
  }
  return "commands and IMU only";
}

const char* source_key(SpeedSource source) {
  return source == SpeedSource::kMeasured   ? "measured"
         : source == SpeedSource::kModelled ? "modelled"
                                            : "commanded";
}

std::string data_sets_text(const FlightIdentification& found) {
  return fmt::format("estimation set {:.1f} s, validation set {:.1f} s; ", found.estimation_set_s,
                     found.validation_set_s) +
         source_text(found.source);
}

std::vector<std::pair<std::string, const std::vector<std::string>*>> notes(
    const FlightIdentificationReport& report) {
  return {{"assumed", &report.assumptions},
          {"not identifiable", &report.found.unexcited},
          {"note", &report.found.findings},
          {"warning", &report.found.warnings}};
}

plot::Figure prediction_figure(const FlightIdentification& found, int quantity, const std::string& label) {
  const identification::PredictionTrace& trace = found.trace;
  std::string title = label + ", predicted by the commands alone";
  if (quantity < 3 || found.source == SpeedSource::kCommanded)
    title += fmt::format(", restarted from the measured value every {:g} s", trace.restart_s);
  plot::Figure figure =
      plot::one_panel(title, "time from the start of the validation set (s)", label, kHeight);
  figure.panels[0].series = {
      {Style::kLine, Colour::kBlue, "measured", plot::points(trace.time_s, trace.measured[quantity])},
      {Style::kLine, Colour::kOrange, "predicted", plot::points(trace.time_s, trace.predicted[quantity])}};
  const auto shown =
      std::lower_bound(trace.time_s.begin(), trace.time_s.end(), kShownS) - trace.time_s.begin();
  for (plot::Series& series : figure.panels[0].series) series.points.resize(static_cast<std::size_t>(shown));
  return figure;
}

plot::Figure flown_thrust_figure(const identification::CommandedThrust& thrust) {
  plot::Series band{Style::kBand, Colour::kBlue, "95 % interval"};
  plot::Series weight{Style::kDashes, Colour::kInk, "weight"};
  const std::size_t count = thrust.command.size();
  for (std::size_t i = 0; i < 2 * count; ++i) {  // below the curve from left to right, above it back
    const std::size_t k = i < count ? i : 2 * count - 1 - i;
    band.points.push_back(
        {thrust.command[k], thrust.over_mass[k] + (i < count ? -1.0 : 1.0) * thrust.half_width[k]});
    if (i < count) weight.points.push_back({thrust.command[k], plant::kGravity});
  }
  plot::Figure figure = plot::one_panel(
      "Thrust over mass by command: steady, all rotors together, over the range of commands in this flight",
      "command of all motors (share of full command)", "thrust over mass (m/s^2)", kHeight);
  figure.panels[0].series = {
      band,
      {Style::kLine, Colour::kBlue, "thrust over mass", plot::points(thrust.command, thrust.over_mass)},
      weight};
  return figure;
}

plot::Figure horizon_figure(const FlightIdentification& found, const std::string& quantity) {
  plot::Figure figure = plot::one_panel("Prediction error by the commands alone, " + quantity,
                                        "prediction horizon (s)", "", kHeight);
  plot::Panel& panel = figure.panels[0];
  panel.zero_line = true;
  panel.series = {{Style::kLine, Colour::kOrange, "by the commands alone"},
                  {Style::kDashes, Colour::kBlue, "persistence baseline"}};
  for (const HorizonError& e : found.horizons) {
    if (e.quantity != quantity) continue;
    panel.series[0].points.push_back({e.horizon_s, e.by_commands});
    panel.series[1].points.push_back({e.horizon_s, e.persistence});
    panel.y.label = "RMS error of " + quantity + " (" + e.unit + ")";
  }
  return figure;
}

std::string ratio_text(const FileComparison& row) {
  if (!row.identified.identifiable) return "-";
  return text_of(row.ratio(), row.identified.half_width / std::abs(row.file)).value;
}
std::string file_text(const FileComparison& row) {
  return row.identified.identifiable ? text_of(row.file, row.identified.half_width).value
                                     : three_digits(row.file);
}

std::string comparison_table(const FlightIdentification& found) {
  if (found.comparisons.empty()) return "";
  std::string out = fmt::format("  {:<30} {:>12}  {:<10} {:>12} {:>8}  {}\n", "comparison with vehicle file",
                                "identified", "+- (95 %)", "file", "ratio", "unit");
  for (const FileComparison& row : found.comparisons) {
    out += fmt::format("  {:<30} {} {:>12} {:>8}  {}\n", row.identified.parameter,
                       table_cells(row.identified), file_text(row), ratio_text(row), row.identified.unit);
  }
  return out;
}

std::string horizon_table(const FlightIdentification& found) {
  if (found.horizons.empty()) return "";
  std::string out = fmt::format("  {:<30} {:>12} {:>12} {:>12}  {}\n", "error by the commands, RMS",
                                "horizon, s", "error", "persistence", "unit");
  for (const HorizonError& e : found.horizons) {
    out += fmt::format("  {:<30} {:>12} {:>12} {:>12}  {}\n", e.quantity, three_digits(e.horizon_s),
                       three_digits(e.by_commands), three_digits(e.persistence), e.unit);
  }
  return out;
}

// A row with a text, numbers and a unit.
pages::Row row_of(pages::Row texts, std::initializer_list<double> numbers, const std::string& unit) {
  for (const double number : numbers) texts.push_back(three_digits(number));
  texts.push_back(unit_cell(unit));
  return texts;
}

void add_comparison(pages::Page& page, const FlightIdentification& found) {
  if (found.comparisons.empty()) return;
  std::vector<pages::Row> rows;
  for (const FileComparison& row : found.comparisons) {
    const ParameterEstimate& e = row.identified;
    const EstimateText text = text_of(e);
    rows.push_back({e.parameter, e.symbol, text.value, text.half_width, file_text(row), ratio_text(row),
                    unit_cell(e.unit)});
  }
  page.heading("Comparison with the vehicle file");
  page.table({"parameter", "symbol", "identified", "\u00b1 (95 %)", "file", "ratio", "unit"}, rows);
}

void add_prediction(pages::Page& page, const FlightIdentification& found) {
  std::vector<pages::Row> rows;
  for (const PredictionError& e : found.errors)
    rows.push_back(row_of({e.quantity},
                          {e.one_step, e.persistence_one_step, e.half_second, e.persistence_half_second},
                          e.unit));
  page.heading("Prediction of the validation set");
  page.table({"RMS error of", "one step", "persistence", "0.5 s", "persistence", "unit"}, rows);
  if (found.step_s > 0.0)
    page.paragraph(
        fmt::format("One step is {:.4g} s. The forecast 0.5 s ahead is the weighted sum of the "
                    "prediction by the commands, the value at the start and the mean that is best on "
                    "the estimation set.",
                    found.step_s),
        "quiet");
  std::vector<plot::Figure> figures;
  const char* const labels[4] = {"p (rad/s)", "q (rad/s)", "r (rad/s)", "specific force along z (m/s^2)"};
  for (int i = 0; i < 4; ++i) figures.push_back(prediction_figure(found, i, labels[i]));
  if (found.source == SpeedSource::kCommanded) {
    figures.push_back(flown_thrust_figure(found.thrust));
    for (const char* const quantity : {"p", "q", "r"}) figures.push_back(horizon_figure(found, quantity));
  }
  page.figures(figures);
}

Json logs_json(const FlightIdentificationReport& report) {
  Json logs = Json::array();
  for (std::size_t i = 0; i < report.logs.size(); ++i) {
    const auto& rows = report.found.windows[i].flight;
    logs.push_back({{"file", report.logs[i]}, {"from_row", rows.first}, {"to_row", rows.last}});
  }
  return logs;
}

Json lag_json(const ParameterEstimate& e) {
  return {
      {"response", e.parameter}, {"value", e.value}, {"interval_95", {e.low(), e.high()}}, {"unit", e.unit}};
}

Json comparison_json(const FileComparison& row) {
  Json json = json_of(row.identified);
  json.erase("symbol");
  json.erase("standard_error");
  json["file"] = row.file;
  json["ratio"] = row.identified.identifiable ? Json(row.ratio()) : Json();
  return json;
}

Json horizon_json(const HorizonError& e) {
  return {{"quantity", e.quantity},
          {"unit", e.unit},
          {"horizon_s", e.horizon_s},
          {"by_commands", e.by_commands},
          {"persistence", e.persistence}};
}

Json prediction_json(const PredictionError& e) {
  return {{"quantity", e.quantity},       {"unit", e.unit},
          {"one_step", e.one_step},       {"persistence_one_step", e.persistence_one_step},
          {"half_second", e.half_second}, {"persistence_half_second", e.persistence_half_second}};
}

template <class Row>
Json list_of(const std::vector<Row>& rows, Json (*json)(const Row&)) {
  Json list = Json::array();
  for (const Row& row : rows) list.push_back(json(row));
  return list;
}

}  // namespace

std::string flight_identification_table(const FlightIdentificationReport& report) {
  const FlightIdentification& found = report.found;
  std::string out = found.vehicle.name + ", identified from";
  for (const std::string& log : report.logs) out += " " + log;
  out += "; other parameters are those of " + report.base_vehicle + "\n  " + data_sets_text(found) + "\n";
  out +=
      fmt::format("  {:<30} {:<17} {:>12}  {:<10} {}\n", "parameter", "symbol", "value", "+- (95 %)", "unit");
  for (const ParameterEstimate& e : found.estimates) {
    out += fmt::format("  {:<30} {:<17} {} {}\n", e.parameter, e.symbol, table_cells(e), e.unit);
  }
  out += comparison_table(found);
  if (found.step_s > 0.0) out += fmt::format("  one step of the predictions is {:.4g} s\n", found.step_s);
  out += fmt::format("  {:<30} {:>12} {:>12} {:>12} {:>12}  {}\n", "prediction error, RMS", "one step",
                     "persistence", "0.5 s", "persistence", "unit");
  for (const PredictionError& e : found.errors) {
    out += fmt::format("  {:<30} {:>12} {:>12} {:>12} {:>12}  {}\n", e.quantity, three_digits(e.one_step),
                       three_digits(e.persistence_one_step), three_digits(e.half_second),
                       three_digits(e.persistence_half_second), e.unit);
  }
  out += horizon_table(found);
  for (const auto& [kind, sentences] : notes(report)) {
    for (const std::string& sentence : *sentences) out += "  " + kind + ": " + sentence + "\n";
  }
  return out;
}

std::string flight_identification_json(const FlightIdentificationReport& report) {
  const FlightIdentification& found = report.found;
  Json out = {{"vehicle", found.vehicle.name},
              {"base_vehicle", report.base_vehicle},
              {"logs", logs_json(report)},
              {"source", source_key(found.source)},
              {"estimation_set_s", found.estimation_set_s},
              {"validation_set_s", found.validation_set_s},
              {"parameters", list_of(found.estimates, json_of)}};
  if (found.source == SpeedSource::kCommanded) {
    out["lags"] = list_of(found.lags, lag_json);
    out["beside_file"] = list_of(found.comparisons, comparison_json);
    out["step_s"] = found.step_s;
    out["horizons"] = list_of(found.horizons, horizon_json);
    out["thrust_per_mass"] = {{"command", found.thrust.command},
                              {"value", found.thrust.over_mass},
                              {"half_width_95", found.thrust.half_width}};
  }
  out["prediction"] = list_of(found.errors, prediction_json);
  out["assumptions"] = report.assumptions;
  out["unexcited"] = found.unexcited;
  out["findings"] = found.findings;
  out["warnings"] = found.warnings;
  return io::json_text(out);
}

pages::Page flight_identification_page(const FlightIdentificationReport& report) {
  const FlightIdentification& found = report.found;
  pages::Page page("Identification of " + found.vehicle.name + " from flights");
  std::string logs;
  for (const std::string& log : report.logs) logs += " " + log;
  page.paragraph(
      "from" + logs + "; " + data_sets_text(found) + "; other parameters are those of " + report.base_vehicle,
      "quiet");
  page.paragraph(
      "95 % intervals by Student's t; residuals may be correlated within segments of half a second", "quiet");
  add_estimates(page, found.estimates);
  for (const auto& [kind, sentences] : notes(report)) {
    const bool loud = kind == "warning" || kind == "not identifiable";
    for (const std::string& sentence : *sentences)
      page.paragraph(kind + ": " + sentence + ".", loud ? "warning" : "finding");
  }
  add_comparison(page, found);
  add_prediction(page, found);
  return page;
}

}  // namespace swiftlet::analysis
