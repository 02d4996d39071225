#include "swiftlet/io/settings/vehicle_writer.hpp"

#include <array>
#include <sstream>
#include <utility>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flat_yaml.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/plant/model/vehicle_visit.hpp"

namespace swiftlet::io {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

template <typename Numbers>
std::string list(const Numbers& numbers) {
  std::string out = "[";
  for (const double number : numbers) out += (out.size() > 1 ? ", " : "") + exact(number);
  return out + "]";
}

// Writes the parameters in the order of their visit. A section begins in a line of its own.
class Writer {
 public:
  Writer(std::ostream& out, const VehicleSources& sources, std::string prefix = "", std::string indent = "")
      : out_(out), sources_(sources), prefix_(std::move(prefix)), indent_(std::move(indent)) {}

  template <class T, class... Arguments>
  void operator()(const plant::Setting& setting, T& value, Arguments...) {
    if constexpr (plant::kIsSection<T>) {
      begin(setting.name.key);
      Writer inside(out_, sources_, prefix_ + setting.name.key + ".", indent_ + "  ");
      visit(value, inside);
    } else {
      write(setting, value);
    }
  }
  template <class Enum>
  void operator()(const plant::Setting& setting, Enum& value, plant::ValueNames names) {
    out_ << indent_ << setting.name.key << ": " << names.begin()[static_cast<int>(value)] << '\n';
  }

 private:
  void begin(const std::string& section) { out_ << indent_ << section << ":\n"; }

  // {value: 1, unit: kg, source: "..."}. A key such as "open_circuit.voltage" is one in a section, which begins with its first.
  void write(const plant::Setting& setting, const std::string& value) {
    const std::string key = setting.name.key;
    const std::size_t dot = key.find('.');
    if (dot != std::string::npos && key.substr(0, dot) != section_) begin(section_ = key.substr(0, dot));
    out_ << indent_ << (dot == std::string::npos ? key : "  " + key.substr(dot + 1)) << ": {value: " << value
         << ", unit: " << setting.unit << ", source: " << source(prefix_ + key) << "}\n";
  }
  void write(const plant::Setting& setting, double value) { write(setting, exact(value)); }
  void write(const plant::Setting& setting, const Eigen::Vector3d& value) {
    write(setting, list(std::array<double, 3>{value.x(), value.y(), value.z()}));
  }
  void write(const plant::Setting& setting, const std::vector<double>& values) {
    write(setting, list(values));
  }
  void write(const plant::Setting& setting, const Eigen::Matrix3d& inertia) {
    begin(setting.name.key);
    out_ << "  value:\n";
    for (int i = 0; i < 3; ++i)
      out_ << "    - " << list(std::array<double, 3>{inertia(i, 0), inertia(i, 1), inertia(i, 2)}) << '\n';
    out_ << "  unit: " << setting.unit << "\n  source: " << inertia_source() << '\n';
  }
  void write(const plant::Setting& setting, std::vector<plant::RotorMount>& mounts) {
    begin(setting.name.key);
    for (std::size_t i = 0; i < mounts.size(); ++i) {
      std::ostringstream mount;
      Writer inside(mount, sources_, "rotors[" + std::to_string(i) + "].", "    ");
      visit(mounts[i], inside);
      out_ << "  - " << mount.str().substr(4);
    }
  }

  std::string source(const std::string& key) const {
    const auto found = sources_.find(key);
    return quoted(found == sources_.end() ? "estimate" : found->second);
  }
  std::string inertia_source() const {
    std::string joined;
    for (const char* key : plant::kInertiaKeys) {
      const auto found = sources_.find(key);
      if (found != sources_.end())
        joined += std::string(joined.empty() ? "" : "; ") + key + " " + found->second;
    }
    if (joined.empty()) return source("inertia");
    const auto rest = sources_.find("inertia");
    return quoted(joined + "; the rest " + (rest == sources_.end() ? "estimate" : rest->second));
  }

  std::ostream& out_;
  const VehicleSources& sources_;
  std::string prefix_;
  std::string indent_;
  std::string section_;
};

void write_uncertainty(std::ostream& out, const plant::VehicleUncertainty& uncertainty) {
  if (uncertainty.parameters.empty()) return;
  out << "\n# Uncertainty of the identified parameters, in their units, and correlations of their "
         "errors.\n"
         "uncertainty:\n  parameters:\n";
  for (const plant::ParameterUncertainty& p : uncertainty.parameters) {
    out << "    - {parameter: " << p.parameter << ", standard_error: " << exact(p.standard_error)
        << ", interval_95: " << list(std::array<double, 2>{p.low, p.high}) << "}\n";
  }
  if (uncertainty.correlations.empty()) return;
  out << "  correlations:\n";
  for (const plant::ParameterCorrelation& c : uncertainty.correlations)
    out << "    - {between: [" << c.first << ", " << c.second << "], value: " << exact(c.value) << "}\n";
}

}  // namespace

VehicleSources parse_vehicle_sources(std::string_view text, const std::string& file_name) {
  constexpr std::string_view kEnding = ".source";
  VehicleSources out;
  for (const auto& [key, value] : flatten_yaml(text, file_name)) {
    if (key.size() > kEnding.size() && key.compare(key.size() - kEnding.size(), kEnding.size(), kEnding) == 0)
      out[key.substr(0, key.size() - kEnding.size())] = value;
  }
  return out;
}

VehicleSources load_vehicle_sources(const std::string& path) {
  return parse_vehicle_sources(read_text_file(path), path);
}

std::string vehicle_text(const plant::Vehicle& vehicle, const VehicleSources& sources,
                         const plant::VehicleUncertainty& uncertainty, const std::string& comment) {
  std::ostringstream out;
  std::istringstream lines(comment);
  for (std::string line; std::getline(lines, line);) out << "# " << line << '\n';
  out << "name: " << quoted(vehicle.name) << "\n\n";
  plant::Vehicle written = vehicle;
  Writer writer(out, sources);
  visit(written, writer);
  write_uncertainty(out, uncertainty);
  return out.str();
}

}  // namespace swiftlet::io
