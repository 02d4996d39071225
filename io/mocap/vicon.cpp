#include "swiftlet/io/mocap/vicon.hpp"

#include "swiftlet/io/byte_reader.hpp"

namespace swiftlet::mocap::vicon {
namespace {

using io::ByteReader;

constexpr std::size_t kSubjectNameBytes = 24;
constexpr std::size_t kContentBytes = kSubjectNameBytes + 6 * 8;
constexpr std::uint8_t kObject = 0;  // kind of an item
constexpr double kLargestMm = 1e6;
constexpr double kLargestAngle = 1e3;  // rad

Eigen::Vector3d read_vector(ByteReader& in) {
  const double x = in.f64();
  const double y = in.f64();
  const double z = in.f64();
  return {x, y, z};
}

Object read_object(ByteReader in) {
  Object object;
  object.name = std::string(in.text_field(kSubjectNameBytes));
  const Eigen::Vector3d position_mm = read_vector(in);
  const Eigen::Vector3d angles = read_vector(in);
  const bool is_zero = position_mm.isZero(0.0) && angles.isZero(0.0);
  object.tracked = !is_zero && position_mm.allFinite() && angles.allFinite() &&
                   position_mm.cwiseAbs().maxCoeff() < kLargestMm &&
                   angles.cwiseAbs().maxCoeff() < kLargestAngle;
  if (!object.tracked) return object;
  object.position = 1e-3 * position_mm;
  object.q_room_from_body = attitude_of(angles.x(), angles.y(), angles.z());
  return object;
}

}  // namespace

Eigen::Quaterniond attitude_of(double about_x, double about_y, double about_z) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(about_x, Vector3d::UnitX()) * AngleAxisd(about_y, Vector3d::UnitY()) *
         AngleAxisd(about_z, Vector3d::UnitZ());
}

const char* parse_frame(const std::uint8_t* data, std::size_t size, Frame& frame) {
  ByteReader in(data, size, true);
  frame.number = in.u32();
  const std::size_t items = in.u8();
  frame.objects.clear();
  for (std::size_t i = 0; i < items; ++i) {
    const std::uint8_t kind = in.u8();
    const std::size_t bytes = in.u16();
    const ByteReader content = in.part(bytes);
    if (!in.ok()) return "an object ends too early";
    if (kind != kObject) continue;
    if (bytes != kContentBytes) return "an object is not 72 bytes long";
    frame.objects.push_back(read_object(content));
    if (frame.objects.back().name.empty()) return "an object has no name";
  }
  return in.ok() ? nullptr : "the frame ends too early";
}

}  // namespace swiftlet::mocap::vicon
