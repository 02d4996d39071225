#include "swiftlet/analysis/identify/identification_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/identify/identification_figures.hpp"
#include "swiftlet/analysis/identify/report_page.hpp"
#include "swiftlet/io/json_text.hpp"

namespace swiftlet::analysis {
namespace {

using identification::BenchIdentification;
using identification::Experiment;
using identification::ParameterEstimate;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kInertiaTitles = {"Moment of inertia, roll", "Moment of inertia, pitch",
                                                       "Moment of inertia, yaw"};
constexpr std::size_t kMostOutliersShown = 30;
constexpr std::size_t kFewOutliers = 4;  // longest list that the page shows open

// One section of the report: a fit with estimates, findings and figures.
struct Part {
  std::string name;  // stem of the file
  std::string title;
  const Experiment* fit = nullptr;
  std::vector<ParameterEstimate> estimates;
  std::vector<std::string> findings;
  std::vector<plot::Figure> figures;
};

Part part_of(const char* name, const char* title, const Experiment& fit, std::vector<plot::Figure> figures) {
  figures.push_back(residual_figure(fit));
  return {name, title, &fit, fit.estimates, fit.findings, std::move(figures)};
}

void add_propeller(Part& part, const std::optional<ParameterEstimate>& coefficient) {
  if (coefficient) part.estimates.push_back(*coefficient);
}

Part motor_step_part(const identification::MotorStepData& data, const BenchIdentification& found) {
  const identification::MotorStep& step = *found.motor_step;
  const bool physical = found.vehicle.motor.model == plant::MotorModel::kPhysical;
  Part part = part_of(identification::kMotorStepName, "Motor step, Eq. (15)-(18)",
                      physical ? step.physical : step.reduced, {motor_step_figure(data, step)});
  ParameterEstimate other = physical ? step.reduced.estimates[0] : step.physical.estimates[0];
  other.parameter = physical ? "motor_step.reduced" : "motor_step.physical";
  part.estimates.insert(part.estimates.end(), {other, step.reading, step.rotor_inertia});
  part.findings = step.findings;
  return part;
}

std::vector<Part> parts_of(const IdentificationReport& report) {
  const identification::BenchData& data = report.bench.data;
  const BenchIdentification& found = report.found;
  std::vector<Part> parts;
  if (found.esc)
    parts.push_back(part_of(identification::kEscName, "ESC, Eq. (7)-(9)", *found.esc,
                            esc_figures(*data.esc, *found.esc)));
  if (found.motor_step) parts.push_back(motor_step_part(*data.motor_step, found));
  if (found.steady_motor)
    parts.push_back(part_of(identification::kSteadyMotorName, "Motor in the steady state, Eq. (19)-(22)",
                            *found.steady_motor,
                            {steady_motor_figure(*data.steady_motor, *found.steady_motor)}));
  if (found.thrust) {
    parts.push_back(part_of(identification::kThrustTorqueName, "Thrust, Eq. (23) and (25)", *found.thrust,
                            {thrust_figure(*data.thrust_torque, *found.thrust)}));
    add_propeller(parts.back(), found.propeller.thrust);
  }
  if (found.torque) {
    parts.push_back(part_of(identification::kThrustTorqueName, "Torque, Eq. (24) and (26)", *found.torque,
                            {torque_figure(*data.thrust_torque, *found.torque)}));
    add_propeller(parts.back(), found.propeller.torque);
    if (found.propeller.figure_of_merit)
      parts.back().findings.push_back(
          fmt::format("figure of merit {:.2f} (ideal over real power, momentum theory)",
                      *found.propeller.figure_of_merit));
  }
  if (found.throttle_thrust)
    parts.push_back(
        part_of(identification::kThrottleThrustName, "Thrust over throttle", *found.throttle_thrust,
                {throttle_thrust_figure(*data.throttle_thrust, *found.throttle_thrust, found.vehicle)}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (found.inertia[axis])
      parts.push_back(
          part_of(identification::kInertiaNames[axis], kInertiaTitles[axis], *found.inertia[axis], {}));
  }
  if (found.mass) parts.push_back(part_of(identification::kMassName, "Mass", *found.mass, {}));
  return parts;
}

// R^2; a dash if the model is a constant, which explains no variance.
std::string r_squared_text(const Experiment& fit) {
  return fit.r_squared > 1e-9 ? fmt::format("{:8.5f}", fit.r_squared) : "       -";
}

std::vector<int> outlier_lines(const IdentificationReport& report, const Part& part) {
  std::vector<int> lines;
  for (const std::size_t row : part.fit->outliers)
    lines.push_back(report.bench.files.at(part.name).lines[row]);
  return lines;
}

void add_outliers(pages::Page& page, const IdentificationReport& report, const Part& part) {
  const std::vector<int> lines = outlier_lines(report, part);
  if (lines.empty()) return;
  page.add(fmt::format("<details{}><summary>{} of {} rows are outliers and are left out</summary>\n",
                       lines.size() <= kFewOutliers ? " open" : "", lines.size(), part.fit->measured.size()));
  std::vector<pages::Row> rows;
  for (std::size_t i = 0; i < std::min(lines.size(), kMostOutliersShown); ++i) {
    const std::size_t row = part.fit->outliers[i];
    rows.push_back({std::to_string(lines[i]), fmt::format("{:.5g}", part.fit->measured[row]),
                    fmt::format("{:.5g}", part.fit->predicted[row]), unit_cell(part.fit->residual_unit)});
  }
  page.table({"line of the file", "measured", "fitted", "unit"}, rows);
  if (lines.size() > kMostOutliersShown)
    page.paragraph(fmt::format("and {} more", lines.size() - kMostOutliersShown), "quiet");
  page.add("</details>\n");
}

void add_part(pages::Page& page, const IdentificationReport& report, const Part& part) {
  const Experiment& fit = *part.fit;
  page.heading(part.title);
  page.paragraph(
      report.bench.files.at(part.name).file +
          fmt::format(": {} rows; R\u00b2 {}; residuals {:.3g} {} (standard deviation)", fit.measured.size(),
                      r_squared_text(fit), fit.residual_sd, unit_cell(fit.residual_unit)),
      "quiet");
  add_estimates(page, part.estimates);
  for (const std::string& finding : part.findings) page.paragraph(finding + ".", "finding");
  for (const std::string& warning : fit.warnings) page.paragraph(warning + ".", "warning");
  add_outliers(page, report, part);
  page.figures(part.figures);
}

void add_summary(pages::Page& page, const IdentificationReport& report) {
  page.paragraph(
      "95 % intervals by Student's t, from the spread of the readings. Parameters that are not listed were "
      "not "
      "measured and are those of the base vehicle " +
          report.base_vehicle + ".",
      "quiet");
  std::vector<pages::Row> rows;
  for (const plant::ParameterUncertainty& p : report.found.uncertainty.parameters) {
    const EstimateText text = text_of(0.5 * (p.low + p.high), 0.5 * (p.high - p.low));
    rows.push_back({p.parameter, text.value, text.half_width, report.found.sources.at(p.parameter)});
  }
  page.table({"parameter", "value", "\u00b1 (95 %)", "source"}, rows);
  for (const std::string& warning : report.found.warnings) page.paragraph(warning + ".", "warning");
}

}  // namespace

pages::Page identification_page(const IdentificationReport& report) {
  pages::Page page("Identification of " + report.found.vehicle.name);
  page.paragraph("from the bench data in " + report.bench_folder +
                     "; equations and figures are numbered as in Phang, Li, Wang, Chen, Lee, Explicit Model "
                     "Identification and Control of a Micro Aerial Vehicle, ICUAS 2014",
                 "quiet");
  add_summary(page, report);
  for (const Part& part : parts_of(report)) add_part(page, report, part);
  return page;
}

std::string identification_table(const IdentificationReport& report) {
  std::string out = report.found.vehicle.name + ", identified from " + report.bench_folder +
                    "; other parameters are those of " + report.base_vehicle + "\n" +
                    fmt::format("  {:<24} {:<7} {:>12}  {:<10} {:<12} {:<16} {:>8} {:>8}\n", "parameter",
                                "symbol", "value", "+- (95 %)", "unit", "from", "R^2", "outliers");
  std::string notes;
  for (const Part& part : parts_of(report)) {
    for (std::size_t i = 0; i < part.estimates.size(); ++i) {
      const ParameterEstimate& e = part.estimates[i];
      out += fmt::format("  {:<24} {:<7} {} {:<12} {:<16}", e.parameter, e.symbol, table_cells(e), e.unit,
                         part.name);
      out +=
          i == 0 ? " " + r_squared_text(*part.fit) + fmt::format(" {:8}\n", part.fit->outliers.size()) : "\n";
    }
    for (const std::string& finding : part.findings) notes += "  " + part.title + ": " + finding + "\n";
    for (const std::string& warning : part.fit->warnings)
      notes += "  warning: " + part.title + ": " + warning + "\n";
    const std::vector<int> lines = outlier_lines(report, part);
    if (lines.empty()) continue;
    notes += "  " + part.title + ": outliers, left out, of " + part.name + ".csv: lines";
    for (std::size_t i = 0; i < std::min(lines.size(), kMostOutliersShown); ++i)
      notes += " " + std::to_string(lines[i]);
    notes += lines.size() > kMostOutliersShown ? " ...\n" : "\n";
  }
  for (const std::string& warning : report.found.warnings) notes += "  warning: " + warning + "\n";
  return out + notes;
}

std::string identification_json(const IdentificationReport& report) {
  Json parameters = Json::array();
  Json experiments = Json::array();
  for (const Part& part : parts_of(report)) {
    for (const ParameterEstimate& estimate : part.estimates) {
      parameters.push_back(json_of(estimate));
      parameters.back()["experiment"] = part.name;
    }
    experiments.push_back({{"name", part.name},
                           {"title", part.title},
                           {"rows", part.fit->measured.size()},
                           {"r_squared", part.fit->r_squared},
                           {"residual_sd", part.fit->residual_sd},
                           {"residual_unit", part.fit->residual_unit},
                           {"outlier_lines", outlier_lines(report, part)},
                           {"findings", part.findings},
                           {"warnings", part.fit->warnings}});
  }
  const Json out = {{"vehicle", report.found.vehicle.name},
                    {"base_vehicle", report.base_vehicle},
                    {"parameters", parameters},
                    {"experiments", experiments},
                    {"warnings", report.found.warnings}};
  return io::json_text(out);
}

}  // namespace swiftlet::analysis
