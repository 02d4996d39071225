// The vehicle's own estimate, and the report of the last obeyed command, which comes with it or with the IMU samples.
#include <cstddef>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire.hpp"

namespace swiftlet::messages {

using namespace wire;

plant::ObeyedCommand from_message(const msg::ObeyedCommand& in) {
  using namespace msg::ObeyedCommand_Constants;
  return {in.state() != UNREPORTED, in.state() == OBEYED, in.term(), in.stamp_ns(), in.boot()};
}

msg::ObeyedCommand to_message(const plant::ObeyedCommand& in) {
  using namespace msg::ObeyedCommand_Constants;
  msg::ObeyedCommand out;
  out.state(!in.reported ? UNREPORTED : in.any ? OBEYED : NONE);
  out.term(in.term);
  out.stamp_ns(in.stamp_ns);
  out.boot(in.boot);
  return out;
}

Fault from_message(const msg::VehicleOdometry& in, plant::OdometrySample& out) {
  Check check;
  check.time(in.stamp_ns());
  if (in.position_valid()) check.finite("position_ned", in.position_ned());
  if (in.velocity_valid()) check.finite("velocity_ned", in.velocity_ned());
  check.unit("q_ned_from_frd", in.q_ned_from_frd()).finite("body_rates_frd", in.body_rates_frd());
  for (const double deviation : in.standard_deviation()) check.at_least("standard_deviation", deviation, 0.0);
  check.at_most("position_source", in.position_source(),
                msg::VehicleOdometry_Constants::POSITION_OF_MOTION_CAPTURE);
  if (!check.ok()) return check.fault();
  out = {};
  out.stamp_ns = in.stamp_ns();
  out.sequence = in.sequence_number();
  out.position_valid = in.position_valid();
  if (out.position_valid) out.position_ned = vector(in.position_ned());
  out.velocity_valid = in.velocity_valid();
  if (out.velocity_valid) out.velocity_ned = vector(in.velocity_ned());
  out.q_ned_from_frd = quaternion(in.q_ned_from_frd());
  out.body_rates_frd = vector(in.body_rates_frd());
  const auto& deviation = in.standard_deviation();
  out.position_deviation = {deviation[0], deviation[1], deviation[2]};
  out.velocity_deviation = {deviation[3], deviation[4], deviation[5]};
  out.rotation_deviation = {deviation[6], deviation[7], deviation[8]};
  out.resets = in.resets();
  out.fuses_mocap = in.position_source() == msg::VehicleOdometry_Constants::POSITION_OF_MOTION_CAPTURE;
  return {};
}

msg::VehicleOdometry to_message(const plant::OdometrySample& in) {
  msg::VehicleOdometry out;
  out.stamp_ns(in.stamp_ns);
  out.sequence_number(in.sequence);
  out.position_valid(in.position_valid);
  out.position_ned(array(in.position_ned));
  out.velocity_valid(in.velocity_valid);
  out.velocity_ned(array(in.velocity_ned));
  out.q_ned_from_frd(array(in.q_ned_from_frd));
  out.body_rates_frd(array(in.body_rates_frd));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    out.standard_deviation()[i] = in.position_deviation[axis];
    out.standard_deviation()[3 + i] = in.velocity_deviation[axis];
    out.standard_deviation()[6 + i] = in.rotation_deviation[axis];
  }
  out.resets(in.resets);
  out.position_source(in.fuses_mocap ? msg::VehicleOdometry_Constants::POSITION_OF_MOTION_CAPTURE
                                     : msg::VehicleOdometry_Constants::POSITION_OF_OWN_SENSORS);
  return out;
}

}  // namespace swiftlet::messages
