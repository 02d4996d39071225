#include "swiftlet/ground/identify/flight_identification_report.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/identify/identification_figures.hpp"
#include "swiftlet/ground/identify/report_page.hpp"
#include "swiftlet/ground/report/svg_figure.hpp"

namespace swiftlet::ground {
namespace {

using identification::FileComparison;
using identification::FlightIdentification;
using identification::HorizonError;
using identification::ParameterEstimate;
using identification::PredictionError;
using identification::SpeedSource;
using Json = nlohmann::ordered_json;

constexpr double kShownS = 8.0;  // s, length of the figures of predictions

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

CaptionedFigure prediction_figure(const FlightIdentification& found, int quantity, const char* label) {
  FigureSeries measured{"measured", Mark::kLine, "#1f6fb4", {}};
  FigureSeries predicted{"predicted", Mark::kLine, "#c0392b", {}};
  const std::vector<double>& time = found.trace.time_s;
  for (std::size_t i = 0; i < time.size() && time[i] < kShownS; ++i) {
    measured.points.push_back({time[i], found.trace.measured[quantity][i]});
    predicted.points.push_back({time[i], found.trace.predicted[quantity][i]});
  }
  Figure figure;
  figure.title = std::string(label) + " over time, measured and predicted";
  figure.x_label = "time from the start of the validation set (s)";
  figure.y_label = label;
  figure.height = 300;
  figure.series = {measured, predicted};
  const bool restarts_all = found.source == SpeedSource::kCommanded;
  return {quantity < 3 || restarts_all
              ? fmt::format("Predicted by the commands alone, restarted from the measured value every {:g} s",
                            found.trace.restart_s)
              : "Predicted by the commands alone",
          figure};
}

CaptionedFigure thrust_figure(const FlightIdentification& found) {
  FigureBand band{"95 % interval", "#c0392b", {}, {}};
  FigureSeries curve{"thrust over mass", Mark::kLine, "#c0392b", {}};
  FigureSeries weight{"weight", Mark::kDashes, "#555555", {}};
  const identification::CommandedThrust& thrust = found.thrust;
  for (std::size_t i = 0; i < thrust.command.size(); ++i) {
    const double command = thrust.command[i];
    band.low.push_back({command, thrust.over_mass[i] - thrust.half_width[i]});
    band.high.push_back({command, thrust.over_mass[i] + thrust.half_width[i]});
    curve.points.push_back({command, thrust.over_mass[i]});
    weight.points.push_back({command, plant::kGravity});
  }
  Figure figure;
  figure.title = "Thrust over mass by command";
  figure.x_label = "command of all motors (share of full command)";
  figure.y_label = "thrust over mass (m/s^2)";
  figure.height = 300;
  figure.bands = {band};
  figure.series = {curve, weight};
  return {"Steady thrust of all rotors together, over the range of commands in this flight", figure};
}

CaptionedFigure horizon_figure(const FlightIdentification& found, const std::string& quantity) {
  FigureSeries by_commands{"by the commands alone", Mark::kLine, "#c0392b", {}};
  FigureSeries persistence{"persistence baseline", Mark::kDashes, "#1f6fb4", {}};
  Figure figure;
  for (const HorizonError& e : found.horizons) {
    if (e.quantity != quantity) continue;
    by_commands.points.push_back({e.horizon_s, e.by_commands});
    persistence.points.push_back({e.horizon_s, e.persistence});
    figure.y_label = "RMS error of " + quantity + " (" + e.unit + ")";
  }
  figure.title = figure.y_label + " over the prediction horizon";
  figure.x_label = "prediction horizon (s)";
  figure.zero_line = true;
  figure.height = 300;
  figure.series = {by_commands, persistence};
  return {"Prediction error by the commands alone, " + quantity, figure};
}

std::string comparison_table(const FlightIdentification& found) {
  if (found.comparisons.empty()) return "";
  std::string out = fmt::format("  {:<30} {:>12}  {:<10} {:>12} {:>8}  {}\n", "comparison with vehicle file",
                                "identified", "+- (95 %)", "file", "ratio", "unit");
  for (const FileComparison& row : found.comparisons) {
    out += fmt::format("  {:<30} {:12.5g}  {:<10.2g} {:12.5g} {:8.3f}  {}\n",
                       row.identified.parameter.c_str(), row.identified.value, row.identified.half_width,
                       row.file, row.ratio(), row.identified.unit.c_str());
  }
  return out;
}

std::string horizon_table(const FlightIdentification& found) {
  if (found.horizons.empty()) return "";
  std::string out = fmt::format("  {:<30} {:>12} {:>12} {:>12}  {}\n", "error by the commands, RMS",
                                "horizon, s", "error", "persistence", "unit");
  for (const HorizonError& e : found.horizons) {
    out += fmt::format("  {:<30} {:12.4g} {:12.4g} {:12.4g}  {}\n", e.quantity.c_str(), e.horizon_s,
                       e.by_commands, e.persistence, e.unit.c_str());
  }
  return out;
}

std::string comparison_html(const FlightIdentification& found) {
  if (found.comparisons.empty()) return "";
  std::string out =
      "<h2>Comparison with the vehicle file</h2>\n<table><tr><th>parameter</th><th>symbol</th>"
      "<th>identified</th><th>&plusmn; (95 %)</th><th>file</th><th>ratio</th><th>unit</th></tr>\n";
  for (const FileComparison& row : found.comparisons) {
    out += "<tr><td>" + html_escaped(row.identified.parameter) + "</td><td>" +
           html_escaped(row.identified.symbol) + "</td>";
    for (const double value : {row.identified.value, row.identified.half_width, row.file, row.ratio()})
      out += fmt::format("<td class=\"n\">{:.4g}</td>", value);
    out += "<td>" + html_unit(row.identified.unit) + "</td></tr>\n";
  }
  return out + "</table>\n";
}

std::string figure_html(const CaptionedFigure& figure) {
  return "<figure>" + svg(figure.figure) + "<figcaption>" + html_escaped(figure.caption) +
         "</figcaption></figure>\n";
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
    out += fmt::format("  {:<30} {:<17} {:12.5g}  {:<10.2g} {}\n", e.parameter.c_str(), e.symbol.c_str(),
                       e.value, e.half_width, e.unit.c_str());
  }
  out += comparison_table(found);
  if (found.step_s > 0.0) out += fmt::format("  one step of the predictions is {:.4g} s\n", found.step_s);
  out += fmt::format("  {:<30} {:>12} {:>12} {:>12} {:>12}  {}\n", "prediction error, RMS", "one step",
                     "persistence", "0.5 s", "persistence", "unit");
  for (const PredictionError& e : found.errors) {
    out += fmt::format("  {:<30} {:12.4g} {:12.4g} {:12.4g} {:12.4g}  {}\n", e.quantity.c_str(), e.one_step,
                       e.persistence_one_step, e.half_second, e.persistence_half_second, e.unit.c_str());
  }
  out += horizon_table(found);
  for (const auto& [kind, sentences] : notes(report)) {
    for (const std::string& sentence : *sentences) out += "  " + kind + ": " + sentence + "\n";
  }
  return out;
}

std::string flight_identification_json(const FlightIdentificationReport& report) {
  const FlightIdentification& found = report.found;
  Json logs = Json::array();
  for (std::size_t i = 0; i < report.logs.size(); ++i) {
    logs.push_back({{"file", report.logs[i]},
                    {"from_row", found.windows[i].flight.first},
                    {"to_row", found.windows[i].flight.last}});
  }
  Json parameters = Json::array();
  for (const ParameterEstimate& e : found.estimates) {
    parameters.push_back({{"parameter", e.parameter},
                          {"symbol", e.symbol},
                          {"value", e.value},
                          {"standard_error", e.standard_error},
                          {"interval_95", {e.low(), e.high()}},
                          {"unit", e.unit}});
  }
  Json prediction = Json::array();
  for (const PredictionError& e : found.errors) {
    prediction.push_back({{"quantity", e.quantity},
                          {"unit", e.unit},
                          {"one_step", e.one_step},
                          {"persistence_one_step", e.persistence_one_step},
                          {"half_second", e.half_second},
                          {"persistence_half_second", e.persistence_half_second}});
  }
  Json out = {{"vehicle", found.vehicle.name},
              {"base_vehicle", report.base_vehicle},
              {"logs", logs},
              {"source", source_key(found.source)},
              {"estimation_set_s", found.estimation_set_s},
              {"validation_set_s", found.validation_set_s},
              {"parameters", parameters}};
  if (found.source == SpeedSource::kCommanded) {
    Json lags = Json::array();
    for (const ParameterEstimate& e : found.lags)
      lags.push_back({{"response", e.parameter},
                      {"value", e.value},
                      {"interval_95", {e.low(), e.high()}},
                      {"unit", e.unit}});
    Json comparisons = Json::array();
    for (const FileComparison& row : found.comparisons) {
      comparisons.push_back({{"parameter", row.identified.parameter},
                             {"value", row.identified.value},
                             {"interval_95", {row.identified.low(), row.identified.high()}},
                             {"file", row.file},
                             {"ratio", row.ratio()},
                             {"unit", row.identified.unit}});
    }
    Json horizons = Json::array();
    for (const HorizonError& e : found.horizons) {
      horizons.push_back({{"quantity", e.quantity},
                          {"unit", e.unit},
                          {"horizon_s", e.horizon_s},
                          {"by_commands", e.by_commands},
                          {"persistence", e.persistence}});
    }
    out["lags"] = lags;
    out["beside_file"] = comparisons;
    out["step_s"] = found.step_s;
    out["horizons"] = horizons;
    out["thrust_per_mass"] = {{"command", found.thrust.command},
                              {"value", found.thrust.over_mass},
                              {"half_width_95", found.thrust.half_width}};
  }
  out["prediction"] = prediction;
  out["assumptions"] = report.assumptions;
  out["unexcited"] = found.unexcited;
  out["findings"] = found.findings;
  out["warnings"] = found.warnings;
  return out.dump();
}

std::string flight_identification_html(const FlightIdentificationReport& report) {
  const FlightIdentification& found = report.found;
  std::string out =
      page_head("Identification of " + found.vehicle.name + " from flights") + "<p class=\"quiet\">from";
  for (const std::string& log : report.logs) out += " " + html_escaped(log);
  out += "; " + html_escaped(data_sets_text(found)) + "; other parameters are those of " +
         html_escaped(report.base_vehicle) +
         "</p>\n<p class=\"quiet\">95 % intervals by Student's t; residuals may be correlated within "
         "segments of half a second</p>\n" +
         estimates_html(found.estimates);
  for (const auto& [kind, sentences] : notes(report)) {
    const bool loud = kind == "warning" || kind == "not identifiable";
    for (const std::string& sentence : *sentences)
      out += std::string("<p class=\"") + (loud ? "warning" : "finding") + "\">" + kind + ": " +
             html_escaped(sentence) + ".</p>\n";
  }
  out += comparison_html(found);
  out +=
      "<h2>Prediction of the validation set</h2>\n<table><tr><th>RMS error of</th><th>one step</th>"
      "<th>persistence</th><th>0.5 s</th><th>persistence</th><th>unit</th></tr>\n";
  for (const PredictionError& e : found.errors) {
    out += "<tr><td>" + html_escaped(e.quantity) + "</td>";
    for (const double value : {e.one_step, e.persistence_one_step, e.half_second, e.persistence_half_second})
      out += fmt::format("<td class=\"n\">{:.4g}</td>", value);
    out += "<td>" + html_unit(e.unit) + "</td></tr>\n";
  }
  out += "</table>\n";
  if (found.step_s > 0.0)
    out += fmt::format(
        "<p class=\"quiet\">One step is {:.4g} s. The forecast 0.5 s ahead is the weighted sum of the "
        "prediction by the commands, the value at the start and the mean that is best on the estimation "
        "set.</p>\n",
        found.step_s);
  out += "<div class=\"figures\">\n";
  const char* const labels[4] = {"p (rad/s)", "q (rad/s)", "r (rad/s)", "specific force along z (m/s^2)"};
  for (int i = 0; i < 4; ++i) {
    const CaptionedFigure figure = prediction_figure(found, i, labels[i]);
    out += figure_html(figure);
  }
  if (found.source == SpeedSource::kCommanded) {
    out += figure_html(thrust_figure(found));
    for (const char* const quantity : {"p", "q", "r"}) out += figure_html(horizon_figure(found, quantity));
  }
  return out + "</div>\n</body></html>\n";
}

}  // namespace swiftlet::ground
