#include "swiftlet/record/flight_trace.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace swiftlet::record {
namespace {

constexpr std::size_t kLongestNumber = 32;

template <class Number>
void append(std::string& row, Number value) {
  char text[kLongestNumber];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  if (!row.empty()) row += ',';
  row.append(text, end);
}

void append_all(std::string& row, const double* values, int count) {
  std::for_each(values, values + count, [&row](double value) { append(row, value); });
}

std::string header(int rotor_count) {
  std::string columns = "t_ns,px,py,pz,vx,vy,vz,qw,qx,qy,qz,p,q,r";
  for (int i = 1; i <= rotor_count; ++i) columns += ",om" + std::to_string(i);
  columns += ",v_s,on_ground,mocap_frame,running";
  for (int i = 1; i <= rotor_count; ++i) columns += ",delta" + std::to_string(i);
  return columns + '\n';
}

}  // namespace

FlightTrace::FlightTrace(const std::string& path, int rotor_count)
    : path_(path), file_(std::fopen(path.c_str(), "w")) {
  if (!file_) fail(errno);
  const std::string columns = header(rotor_count);
  if (std::fwrite(columns.data(), 1, columns.size(), file_.get()) != columns.size()) fail(errno);
}

void FlightTrace::add(const plant::TruthSample& truth, const plant::ActuatorCommand& command) {
  if (complete_ || error_ != 0) return;
  const bool runs = command.rotor_state == plant::RotorState::kRunning;
  complete_ = running_ && !runs;
  running_ = runs;

  row_.clear();
  append(row_, truth.stamp_ns);
  append_all(row_, truth.position_ned.data(), 3);
  append_all(row_, truth.velocity_ned.data(), 3);
  const Eigen::Quaterniond& q = truth.q_ned_from_frd;
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) append(row_, value);
  append_all(row_, truth.body_rates_frd.data(), 3);
  append_all(row_, truth.rotor_speeds.data(), truth.rotor_count);
  append(row_, truth.supply_voltage_v);
  append(row_, truth.on_ground ? 1 : 0);
  append(row_, command.mocap_sequence);
  append(row_, runs ? 1 : 0);
  append_all(row_, command.throttle.data(), command.rotor_count);
  row_ += '\n';
  if (std::fwrite(row_.data(), 1, row_.size(), file_.get()) != row_.size()) error_ = errno;
}

void FlightTrace::close() {
  if (!file_) return;
  if (std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) fail(error_);
}

void FlightTrace::fail(int error) const {
  throw std::runtime_error(path_ + ": cannot be written: " + std::generic_category().message(error));
}

}  // namespace swiftlet::record
