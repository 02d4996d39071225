#include "swiftlet/io/mocap/vrpn.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/byte_writer.hpp"

namespace swiftlet::mocap::vrpn {
namespace {

using io::ByteReader;

constexpr std::string_view kMagic = "vrpn: ver. 07.";  // followed by the minor version, which does not matter
constexpr std::string_view kCookie = "vrpn: ver. 07.35  0";
constexpr std::size_t kAlignment = 8;
constexpr std::size_t kLongestName = 100;

constexpr std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

void put(Bytes& out, std::uint32_t value) { io::append(out, value, false); }

}  // namespace

const char* fault_of_cookie(const std::uint8_t* cookie) {
  const std::string_view text(reinterpret_cast<const char*>(cookie), kCookieBytes);
  if (text.substr(0, kMagic.size()) == kMagic) return nullptr;
  return text.substr(0, 11) == kMagic.substr(0, 11) ? "it has another version of VRPN than 7"
                                                    : "it does not speak VRPN";
}

Parsed parse_message(const std::uint8_t* data, std::size_t size, Message& message) {
  ByteReader in(data, size, false);
  const std::size_t length = in.u32();  // without the padding at the end
  if (size >= 4 && (length < kHeaderBytes || length > kLongestMessage)) return Parsed::kFault;
  const std::int64_t seconds = in.u32();
  const std::int64_t microseconds = in.i32();
  message.sender = in.i32();
  message.type = in.i32();
  message.sequence = in.u32();
  if (!in.ok() || aligned(length) > size) return Parsed::kIncomplete;
  if (microseconds < 0 || microseconds >= 1'000'000) return Parsed::kFault;
  message.stamp_ns = seconds * 1'000'000'000 + microseconds * 1000;
  message.payload = in.part(length - kHeaderBytes);
  message.bytes = aligned(length);
  return Parsed::kMessage;
}

std::optional<std::string> parse_description(ByteReader payload) {
  const std::size_t length = payload.u32();
  if (!payload.ok() || length == 0 || length > payload.rest()) return std::nullopt;
  const std::string_view name = payload.text_field(length);
  if (name.empty() || name.size() > kLongestName) return std::nullopt;
  return std::string(name);
}

const char* parse_pose(ByteReader payload, Pose& pose) {
  pose.sensor = payload.i32();
  payload.skip(4);
  double numbers[7];
  for (double& number : numbers) number = payload.f64();
  if (!payload.ok()) return "a pose is shorter than 64 bytes";
  pose.position = {numbers[0], numbers[1], numbers[2]};
  pose.q_room_from_body = {numbers[6], numbers[3], numbers[4], numbers[5]};
  if (!pose.position.allFinite() || !pose.q_room_from_body.coeffs().allFinite())
    return "a pose has a number that is not finite";
  if (std::abs(pose.q_room_from_body.norm() - 1.0) > 1e-3) return "a quaternion is not of unit length";
  return nullptr;
}

Bytes cookie() {
  Bytes out(kCookie.begin(), kCookie.end());
  out.resize(kCookieBytes);
  return out;
}

Bytes message(std::int64_t stamp_ns, std::int32_t sender, std::int32_t type, const Bytes& payload) {
  Bytes out;
  put(out, static_cast<std::uint32_t>(kHeaderBytes + payload.size()));
  put(out, static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
  put(out, static_cast<std::uint32_t>(stamp_ns % 1'000'000'000 / 1000));
  put(out, static_cast<std::uint32_t>(sender));
  put(out, static_cast<std::uint32_t>(type));
  put(out, 0);
  out.insert(out.end(), payload.begin(), payload.end());
  out.resize(aligned(out.size()));
  return out;
}

Bytes description(std::int32_t kind, std::int32_t number, std::string_view name) {
  Bytes payload;
  put(payload, static_cast<std::uint32_t>(name.size() + 1));
  payload.insert(payload.end(), name.begin(), name.end());
  payload.push_back(0);
  return message(0, number, kind, payload);
}

Bytes udp_description(std::string_view address, std::uint16_t port) {
  Bytes payload(address.begin(), address.end());
  payload.push_back(0);
  return message(0, port, kUdpDescription, payload);
}

}  // namespace swiftlet::mocap::vrpn
