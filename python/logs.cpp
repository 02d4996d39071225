// Recorded flights as arrays.
#include <map>
#include <set>

#include "bindings.hpp"

#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/record/mcap/series.hpp"
#include "swiftlet/record/mcap/signal_arrays.hpp"
#include "swiftlet/record/mcap/topic_decoder.hpp"

namespace swiftlet::python {
namespace {

using namespace py::literals;

template <class T, class Of>
py::array columns_of(std::size_t rows, std::size_t count, const Of& of) {
  if (count == 1) return array_of(of(0));
  py::array_t<T> out({rows, count});
  auto view = out.template mutable_unchecked<2>();
  for (std::size_t column = 0; column < count; ++column) {
    const std::vector<T>& values = of(column);
    for (std::size_t row = 0; row < rows; ++row)
      view(static_cast<py::ssize_t>(row), static_cast<py::ssize_t>(column)) = values[row];
  }
  return std::move(out);
}

py::dict dict_of(const mcap::Series& series) {
  py::dict out;
  out["log_time_ns"] = array_of(series.log_time_ns());
  for (const mcap::SignalArray& array : mcap::signal_arrays(series.columns())) {
    const auto name = [&](std::size_t i) { return series.columns()[array.first + i].name; };
    switch (array.kind) {
      case mcap::Column::Kind::kFloat:
      case mcap::Column::Kind::kSigned:
        out[array.name.c_str()] = columns_of<double>(
            series.size(), array.count,
            [&](std::size_t i) -> const std::vector<double>& { return series.numbers(name(i)); });
        break;
      case mcap::Column::Kind::kUnsigned:
        out[array.name.c_str()] = columns_of<std::uint64_t>(
            series.size(), array.count,
            [&](std::size_t i) -> const std::vector<std::uint64_t>& { return series.integers(name(i)); });
        break;
      case mcap::Column::Kind::kText:
        out[array.name.c_str()] = py::cast(series.texts(name(0)));
        break;
    }
  }
  out["stamp_ns"] = array_of(series.stamp_ns());
  return out;
}

py::dict read_mcap(const std::string& path, const std::vector<std::string>& topics) {
  std::map<std::string, mcap::Series> all;
  {
    const py::gil_scoped_release without_gil;
    const mcap::Reader file(path);
    mcap::Selection selection;
    selection.topics = std::set<std::string>(topics.begin(), topics.end());
    all = mcap::read_series(file, selection);
  }
  py::dict out;
  for (const auto& [topic, series] : all) {
    if (series.size() > 0) out[topic.c_str()] = dict_of(series);
  }
  return out;
}

template <class Rows>
py::array_t<double> vectors(const Rows& rows) {
  py::array_t<double> out({rows.size(), std::size_t{3}});
  auto view = out.mutable_unchecked<2>();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (int axis = 0; axis < 3; ++axis) view(static_cast<py::ssize_t>(row), axis) = rows[row][axis];
  }
  return out;
}

py::array_t<double> per_rotor(const std::vector<plant::PerRotor>& rows, int rotors) {
  py::array_t<double> out(std::vector<py::ssize_t>{static_cast<py::ssize_t>(rows.size()), rotors});
  auto view = out.mutable_unchecked<2>();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (int rotor = 0; rotor < rotors; ++rotor)
      view(static_cast<py::ssize_t>(row), rotor) = rows[row][static_cast<std::size_t>(rotor)];
  }
  return out;
}

py::dict read_sensors(const std::string& path, const VehicleArgument& vehicle,
                      const std::string& vehicle_name) {
  const identification::FlightLog log =
      analysis::read_flight_log(path, vehicle_of(vehicle), analysis::BodyAxes::kDetected, vehicle_name).log;
  py::dict out("time_s"_a = array_of(log.time_s), "specific_force_frd"_a = vectors(log.specific_force_frd),
               "body_rates_frd"_a = vectors(log.body_rates_frd),
               "throttle"_a = per_rotor(log.command, log.rotor_count));
  if (!log.supply_voltage_v.empty()) out["supply_voltage_v"] = array_of(log.supply_voltage_v);
  if (!log.rotor_speeds.empty()) out["rotor_speeds"] = per_rotor(log.rotor_speeds, log.rotor_count);
  std::vector<double> time_s, attitude;
  std::vector<Eigen::Vector3d> position;
  for (const identification::FlightPose& pose : log.poses) {
    time_s.push_back(pose.time_s);
    position.push_back(pose.position_ned);
    const Eigen::Quaterniond& q = pose.q_ned_from_frd;
    attitude.insert(attitude.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  out["pose_time_s"] = array_of(time_s);
  out["pose_position_ned"] = vectors(position);
  out["pose_q_ned_from_frd"] = array_of(attitude, 4);
  return out;
}

}  // namespace

void add_logs(py::module_& module) {
  module.def("read_mcap", &read_mcap, "path"_a, "topics"_a = std::vector<std::string>{},
             "The messages of an MCAP file as arrays: by topic ('/kl1/estimate'), then by field "
             "('position_ned'), with a row "
             "for each message, and a column for each element of an array. Signed numbers and floats are "
             "float64, unsigned "
             "ones uint64, texts a list, log_time_ns and stamp_ns int64. topics: only these; without it all "
             "that can be "
             "decoded. Throws InputError.");
  module.def(
      "mcap_topics", [](const std::string& path) { return mcap::decodable_topics(mcap::Reader(path)); },
      "path"_a, "The topics of an MCAP file that read_mcap() can read, sorted.");
  module.def(
      "mcap_vehicles", [](const std::string& path) { return record::recorded_vehicles(mcap::Reader(path)); },
      "path"_a, "The vehicles of which an MCAP file has messages, sorted.");
  module.def(
      "read_sensors", &read_sensors, "path"_a, "vehicle"_a = "kaylion", "vehicle_name"_a = "",
      "The samples of a flight as `swiftlet identify flight` reads them: from the record of a flight, "
      "flight.mcap, a "
      "record folder "
      "or a CSV log of another project. A row for each IMU sample: time_s; specific_force_frd (n, 3) m/s^2, "
      "body_rates_frd (n, 3) rad/s, throttle (n, rotors) 0 .. 1, and if recorded supply_voltage_v and "
      "rotor_speeds "
      "(n, rotors) rad/s; and a row for each pose: pose_time_s, pose_position_ned (m, 3), "
      "pose_q_ned_from_frd (m, 4) "
      "w, x, y, z. vehicle: its ESC converts pulse widths. vehicle_name: of several in an MCAP file. Throws "
      "InputError.");
}

}  // namespace swiftlet::python
