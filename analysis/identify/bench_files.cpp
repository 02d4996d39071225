#include "swiftlet/analysis/identify/bench_files.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/io/measurements.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;
using identification::BenchData;
using io::Measurements;
using io::Quantity;

std::vector<std::string> experiment_names() {
  std::vector<std::string> names = {identification::kMassName,         identification::kEscName,
                                    identification::kThrustTorqueName, identification::kSteadyMotorName,
                                    identification::kMotorStepName,    identification::kThrottleThrustName};
  names.insert(names.end(), identification::kInertiaNames.begin(), identification::kInertiaNames.end());
  return names;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name + ".csv";
  return text;
}

void refuse_unknown_tables(const fs::path& folder) {
  const std::vector<std::string> known = experiment_names();
  std::set<fs::path> tables;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    std::string extension = entry.path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".csv") tables.insert(entry.path());
  }
  if (fault) throw io::InputError(folder.string() + ": cannot be read: " + fault.message());
  for (const fs::path& table : tables) {
    if (table.extension() != ".csv" ||
        std::find(known.begin(), known.end(), table.stem().string()) == known.end())
      throw io::InputError(table.string() + ": is not a known experiment, must be one of " + joined(known));
  }
  if (tables.empty())
    throw io::InputError(folder.string() + ": contains no experiment, must contain at least one of " +
                         joined(known));
}

std::vector<double> column_or_nothing(const Measurements& table, Quantity quantity) {
  return table.has(quantity) ? table.column(quantity) : std::vector<double>();
}

// Throttle delta of Eq. (8), from the column of throttles or of pulse widths.
std::vector<double> throttles(const Measurements& table, const plant::Esc& esc) {
  if (table.has(Quantity::kThrottle) && table.has(Quantity::kPulseWidth)) {
    throw io::ConfigError(
        table.file(), 1, "header",
        "has a throttle and a pulse width, must have one of them: Eq. (8) converts one to the other");
  }
  if (!table.has(Quantity::kPulseWidth)) return table.column(Quantity::kThrottle);
  std::vector<double> out;
  const std::vector<double>& pulses = table.column(Quantity::kPulseWidth);
  for (std::size_t row = 0; row < pulses.size(); ++row) {
    const io::Bounds range = io::between(esc.pulse_min_us, esc.pulse_min_us + esc.pulse_range_us);
    if (!range.contains(pulses[row])) {
      throw io::ConfigError(table.file(), table.line(row), io::name_of(Quantity::kPulseWidth),
                            "is " + io::exact(pulses[row]) + " us, must be " + range.to_string() +
                                " us, the range of the base vehicle's ESC; is the unit right?");
    }
    out.push_back((pulses[row] - esc.pulse_min_us) / esc.pulse_range_us);
  }
  return out;
}

// Reads the tables that exist.
class Loader {
 public:
  Loader(fs::path folder, const plant::Esc& esc) : folder_(std::move(folder)), esc_(esc) {}

  template <typename Use>
  void read(const char* name, const std::vector<Quantity>& allowed, const Use& use) {
    const fs::path file = folder_ / (std::string(name) + ".csv");
    if (!fs::exists(file)) return;
    const Measurements table = io::load_measurements(file.string(), allowed);
    use(table);
    BenchFile& note = bench.files[name];
    note.file = file.string();
    for (std::size_t row = 0; row < table.row_count(); ++row) note.lines.push_back(table.line(row));
  }

  void read_all() {
    BenchData& data = bench.data;
    read(identification::kMassName, {Quantity::kMass},
         [&](const Measurements& t) { data.mass_kg = t.column(Quantity::kMass); });
    read(identification::kEscName,
         {Quantity::kSupplyVoltage, Quantity::kThrottle, Quantity::kPulseWidth, Quantity::kMotorVoltage},
         [&](const Measurements& t) {
           data.esc = {t.column(Quantity::kSupplyVoltage), throttles(t, esc_),
                       t.column(Quantity::kMotorVoltage)};
         });
    read(identification::kThrustTorqueName, {Quantity::kSpeed, Quantity::kThrust, Quantity::kTorque},
         [&](const Measurements& t) {
           data.thrust_torque = {t.column(Quantity::kSpeed), column_or_nothing(t, Quantity::kThrust),
                                 column_or_nothing(t, Quantity::kTorque)};
         });
    read(identification::kSteadyMotorName, {Quantity::kMotorVoltage, Quantity::kSpeed},
         [&](const Measurements& t) {
           data.steady_motor = {t.column(Quantity::kMotorVoltage), t.column(Quantity::kSpeed)};
         });
    read(identification::kMotorStepName, {Quantity::kTime, Quantity::kSpeed, Quantity::kMotorVoltage},
         [&](const Measurements& t) {
           data.motor_step = {t.column(Quantity::kTime), t.column(Quantity::kSpeed),
                              column_or_nothing(t, Quantity::kMotorVoltage)};
         });
    read(identification::kThrottleThrustName,
         {Quantity::kSupplyVoltage, Quantity::kThrottle, Quantity::kPulseWidth, Quantity::kThrust},
         [&](const Measurements& t) {
           data.throttle_thrust = {t.column(Quantity::kSupplyVoltage), throttles(t, esc_),
                                   t.column(Quantity::kThrust)};
         });
    for (std::size_t axis = 0; axis < 3; ++axis) {
      read(identification::kInertiaNames[axis],
           {Quantity::kLength, Quantity::kSeparation, Quantity::kArm, Quantity::kPeriod},
           [&](const Measurements& t) { data.inertia[axis] = inertia(t); });
    }
  }

  Bench bench;

 private:
  static identification::InertiaData inertia(const Measurements& t) {
    const bool strings = t.has(Quantity::kLength) || t.has(Quantity::kSeparation);
    if (strings == t.has(Quantity::kArm)) {
      throw io::ConfigError(
          t.file(), 1, "header",
          "must have either length and separation (bifilar pendulum) or arm (physical pendulum)");
    }
    if (!strings)
      return {{}, identification::SwingData{t.column(Quantity::kArm), t.column(Quantity::kPeriod)}};
    return {identification::BifilarData{t.column(Quantity::kLength), t.column(Quantity::kSeparation),
                                        t.column(Quantity::kPeriod)},
            {}};
  }

  fs::path folder_;
  const plant::Esc& esc_;
};

std::optional<double> spread_of(const io::ConfigNode& instruments, const char* key, const char* unit) {
  const auto node = instruments.find(key);
  return node ? std::optional<double>(node->quantity(unit).number(io::above(0.0))) : std::nullopt;
}

void write_table(const fs::path& file,
                 const std::vector<std::pair<Quantity, const std::vector<double>*>>& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const auto& [quantity, values] : columns) names.push_back(io::header_of(quantity));
  io::CsvWriter csv(file, names);
  for (std::size_t row = 0; row < columns.front().second->size(); ++row) {
    for (const auto& [quantity, values] : columns) csv.exact((*values)[row]);
    csv.end_row();
  }
  csv.finish();
}

}  // namespace

BenchSettings load_bench_settings(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw io::InputError(folder.string() + ": is not a folder, must be a folder of bench data");
  BenchSettings out;
  const fs::path file = folder / kBenchSettingsFile;
  if (!fs::exists(file)) return out;
  const io::ConfigNode root = io::load_config(file.string());
  if (const auto base = root.find("base_vehicle")) {
    const fs::path inside = folder / base->text();
    out.base_vehicle = fs::is_regular_file(inside) ? inside.string() : base->text();
    out.base_vehicle_line = base->line();
  }
  if (const auto name = root.find("name")) out.name = name->text();
  if (const auto propeller = root.find("propeller")) {
    out.propeller =
        identification::Propeller{propeller->at("radius").quantity("m").number(io::above(0.0)),
                                  propeller->at("air_density").quantity("kg/m^3").number(io::above(0.0))};
  }
  if (const auto instruments = root.find("instruments")) {
    out.instruments = {spread_of(*instruments, "supply_voltage", "V"),
                       spread_of(*instruments, "motor_voltage", "V"),
                       spread_of(*instruments, "speed", "rad/s"), spread_of(*instruments, "thrust", "N"),
                       spread_of(*instruments, "torque", "N*m")};
  }
  root.reject_unknown_keys();
  return out;
}

Bench load_bench(const fs::path& folder, const BenchSettings& settings, const plant::Esc& esc) {
  refuse_unknown_tables(folder);
  Loader loader(folder, esc);
  loader.read_all();
  loader.bench.data.propeller = settings.propeller;
  loader.bench.data.instruments = settings.instruments;
  return std::move(loader.bench);
}

void write_bench(const fs::path& folder, const BenchData& data, const std::string& settings_yaml) {
  fs::create_directories(folder);
  const auto file = [&](const char* name) { return folder / (std::string(name) + ".csv"); };
  if (data.mass_kg) write_table(file(identification::kMassName), {{Quantity::kMass, &*data.mass_kg}});
  if (data.esc) {
    write_table(file(identification::kEscName), {{Quantity::kSupplyVoltage, &data.esc->supply_voltage_v},
                                                 {Quantity::kThrottle, &data.esc->throttle},
                                                 {Quantity::kMotorVoltage, &data.esc->motor_voltage_v}});
  }
  if (data.thrust_torque) {
    write_table(file(identification::kThrustTorqueName),
                {{Quantity::kSpeed, &data.thrust_torque->speed_rad_s},
                 {Quantity::kThrust, &data.thrust_torque->thrust_n},
                 {Quantity::kTorque, &data.thrust_torque->torque_n_m}});
  }
  if (data.steady_motor) {
    write_table(file(identification::kSteadyMotorName),
                {{Quantity::kMotorVoltage, &data.steady_motor->motor_voltage_v},
                 {Quantity::kSpeed, &data.steady_motor->speed_rad_s}});
  }
  if (data.motor_step) {
    write_table(file(identification::kMotorStepName),
                {{Quantity::kTime, &data.motor_step->time_s},
                 {Quantity::kMotorVoltage, &data.motor_step->motor_voltage_v},
                 {Quantity::kSpeed, &data.motor_step->speed_rad_s}});
  }
  if (data.throttle_thrust) {
    write_table(file(identification::kThrottleThrustName),
                {{Quantity::kSupplyVoltage, &data.throttle_thrust->supply_voltage_v},
                 {Quantity::kThrottle, &data.throttle_thrust->throttle},
                 {Quantity::kThrust, &data.throttle_thrust->thrust_n}});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!data.inertia[axis] || !data.inertia[axis]->bifilar) continue;
    const identification::BifilarData& strings = *data.inertia[axis]->bifilar;
    write_table(file(identification::kInertiaNames[axis]), {{Quantity::kLength, &strings.length_m},
                                                            {Quantity::kSeparation, &strings.separation_m},
                                                            {Quantity::kPeriod, &strings.period_s}});
  }
  io::write_atomically(folder / kBenchSettingsFile, settings_yaml);
}

}  // namespace swiftlet::analysis
