#include "swiftlet/analysis/identify/bench_files.hpp"

#include <algorithm>
#include <set>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/config.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/io/measurements.hpp"
#include "swiftlet/io/text.hpp"

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

void refuse_unknown_tables(const fs::path& folder) {
  const std::vector<std::string> known = experiment_names();
  const std::string choices = io::joined(known, ".csv, ") + ".csv";
  std::set<fs::path> tables;
  std::error_code fault;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, fault)) {
    if (io::lower(entry.path().extension().string()) == ".csv") tables.insert(entry.path());
  }
  if (fault) throw io::InputError(folder.string() + ": cannot be read: " + fault.message());
  for (const fs::path& table : tables) {
    if (table.extension() != ".csv" ||
        std::find(known.begin(), known.end(), table.stem().string()) == known.end())
      throw io::InputError(table.string() + ": is not a known experiment, must be one of " + choices);
  }
  if (tables.empty())
    throw io::InputError(folder.string() + ": contains no experiment, must contain at least one of " +
                         choices);
}

// A column of an experiment, and where its values are.
struct BenchColumn {
  Quantity quantity;
  std::vector<double>* values;
  bool may_be_missing = false;
};
using BenchColumns = std::vector<BenchColumn>;

// Calls use(name, data, columns of the data) for each experiment but the pendulums.
template <typename Use>
void for_each_experiment(BenchData& data, const Use& use) {
  use(identification::kMassName, data.mass_kg, [](auto& d) { return BenchColumns{{Quantity::kMass, &d}}; });
  use(identification::kEscName, data.esc, [](auto& d) {
    return BenchColumns{{Quantity::kSupplyVoltage, &d.supply_voltage_v},
                        {Quantity::kThrottle, &d.throttle},
                        {Quantity::kMotorVoltage, &d.motor_voltage_v}};
  });
  use(identification::kThrustTorqueName, data.thrust_torque, [](auto& d) {
    return BenchColumns{{Quantity::kSpeed, &d.speed_rad_s},
                        {Quantity::kThrust, &d.thrust_n, true},
                        {Quantity::kTorque, &d.torque_n_m, true}};
  });
  use(identification::kSteadyMotorName, data.steady_motor, [](auto& d) {
    return BenchColumns{{Quantity::kMotorVoltage, &d.motor_voltage_v}, {Quantity::kSpeed, &d.speed_rad_s}};
  });
  use(identification::kMotorStepName, data.motor_step, [](auto& d) {
    return BenchColumns{{Quantity::kTime, &d.time_s},
                        {Quantity::kMotorVoltage, &d.motor_voltage_v, true},
                        {Quantity::kSpeed, &d.speed_rad_s}};
  });
  use(identification::kThrottleThrustName, data.throttle_thrust, [](auto& d) {
    return BenchColumns{{Quantity::kSupplyVoltage, &d.supply_voltage_v},
                        {Quantity::kThrottle, &d.throttle},
                        {Quantity::kThrust, &d.thrust_n}};
  });
}

BenchColumns columns_of(identification::BifilarData& data) {
  return {{Quantity::kLength, &data.length_m},
          {Quantity::kSeparation, &data.separation_m},
          {Quantity::kPeriod, &data.period_s}};
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

  void read_all() {
    for_each_experiment(bench.data, [&](const char* name, auto& data, const auto& columns_in) {
      if (!fs::exists(file_of(name))) return;
      const BenchColumns columns = columns_in(data.emplace());
      std::vector<Quantity> allowed;
      for (const BenchColumn& column : columns) {
        allowed.push_back(column.quantity);
        if (column.quantity == Quantity::kThrottle) allowed.push_back(Quantity::kPulseWidth);
      }
      fill(columns, read(name, allowed));
    });
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const char* const name = identification::kInertiaNames[axis];
      if (!fs::exists(file_of(name))) continue;
      bench.data.inertia[axis] =
          inertia(read(name, {Quantity::kLength, Quantity::kSeparation, Quantity::kArm, Quantity::kPeriod}));
    }
  }

  Bench bench;

 private:
  fs::path file_of(const char* name) const { return folder_ / (std::string(name) + ".csv"); }

  Measurements read(const char* name, const std::vector<Quantity>& allowed) {
    Measurements table = io::load_measurements(file_of(name).string(), allowed);
    BenchFile& note = bench.files[name];
    note.file = table.file();
    for (std::size_t row = 0; row < table.row_count(); ++row) note.lines.push_back(table.line(row));
    return table;
  }

  void fill(const BenchColumns& columns, const Measurements& table) const {
    for (const BenchColumn& column : columns) {
      if (column.may_be_missing && !table.has(column.quantity)) continue;
      *column.values =
          column.quantity == Quantity::kThrottle ? throttles(table, esc_) : table.column(column.quantity);
    }
  }

  identification::InertiaData inertia(const Measurements& t) const {
    const bool strings = t.has(Quantity::kLength) || t.has(Quantity::kSeparation);
    if (strings == t.has(Quantity::kArm)) {
      throw io::ConfigError(
          t.file(), 1, "header",
          "must have either length and separation (bifilar pendulum) or arm (physical pendulum)");
    }
    if (!strings)
      return {{}, identification::SwingData{t.column(Quantity::kArm), t.column(Quantity::kPeriod)}};
    identification::BifilarData data;
    fill(columns_of(data), t);
    return {std::move(data), {}};
  }

  fs::path folder_;
  const plant::Esc& esc_;
};

std::optional<double> spread_of(const io::ConfigNode& instruments, const char* key, const char* unit) {
  const auto node = instruments.find(key);
  return node ? std::optional<double>(node->quantity(unit).number(io::above(0.0))) : std::nullopt;
}

void write_table(const fs::path& file, const BenchColumns& columns) {
  std::vector<std::string> names;
  names.reserve(columns.size());
  for (const BenchColumn& column : columns) names.push_back(io::header_of(column.quantity));
  io::CsvWriter csv(file, names);
  for (std::size_t row = 0; row < columns.front().values->size(); ++row) {
    for (const BenchColumn& column : columns) csv.exact((*column.values)[row]);
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

void write_bench(const fs::path& folder, BenchData data, const std::string& settings_yaml) {
  fs::create_directories(folder);
  const auto file = [&](const char* name) { return folder / (std::string(name) + ".csv"); };
  for_each_experiment(data, [&](const char* name, auto& experiment, const auto& columns_in) {
    if (experiment) write_table(file(name), columns_in(*experiment));
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!data.inertia[axis] || !data.inertia[axis]->bifilar) continue;
    write_table(file(identification::kInertiaNames[axis]), columns_of(*data.inertia[axis]->bifilar));
  }
  io::write_atomically(folder / kBenchSettingsFile, settings_yaml);
}

}  // namespace swiftlet::analysis
