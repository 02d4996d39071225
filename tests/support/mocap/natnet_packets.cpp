#include "tests/support/mocap/natnet_packets.hpp"

#include "swiftlet/io/byte_writer.hpp"

namespace swiftlet::tests::natnet {
namespace {

// Little-endian.
class Writer {
 public:
  template <class Number>
  Writer& put(Number number) {
    io::append(bytes_, number);
    return *this;
  }
  Writer& text(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  Writer& field(const std::string& text, std::size_t bytes) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.resize(bytes_.size() + bytes - text.size());
    return *this;
  }
  Writer& zeros(std::size_t bytes) {
    bytes_.resize(bytes_.size() + bytes);
    return *this;
  }
  Writer& append(const Bytes& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  Writer& vector(float x, float y, float z) { return put(x).put(y).put(z); }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

Bytes message(std::uint16_t id, const Bytes& payload) {
  return Writer().put(id).put(static_cast<std::uint16_t>(payload.size())).append(payload).bytes();
}

bool has_sizes(Version version) { return version.major == 4 && version.minor >= 1; }

// A section of a frame.
void section(Writer& out, Version version, std::int32_t count, const Bytes& content) {
  out.put(count);
  if (has_sizes(version)) out.put(static_cast<std::int32_t>(content.size()));
  out.append(content);
}

void rigid_body(Writer& out, const Body& body) {
  out.put(body.id);
  for (const float number : body.position) out.put(number);
  for (const float number : body.q_xyzw) out.put(number);
  out.put(0.0003F).put(static_cast<std::int16_t>(body.tracked ? 1 : 0));
}

void analog_data(Writer& out, std::int32_t id) {
  out.put(id).put(std::int32_t{2});
  for (int channel = 0; channel < 2; ++channel) out.put(std::int32_t{3}).put(1.0F).put(2.0F).put(3.0F);
}

void definition(Writer& out, Version version, std::int32_t kind, const Bytes& content) {
  out.put(kind);
  if (has_sizes(version)) out.put(static_cast<std::int32_t>(content.size()));
  out.append(content);
}

void body_definition(Writer& out, Version version, const std::string& name, std::int32_t id, int markers) {
  out.text(name).put(id).put(std::int32_t{-1}).vector(0.1F, 0.2F, 0.3F);
  if (version.major == 4 && version.minor >= 2) out.put(0.0F).put(0.0F).put(0.0F).put(1.0F);
  if (markers < 0) return;
  out.put(static_cast<std::int32_t>(markers));
  for (int i = 0; i < markers; ++i) out.vector(0.05F, 0.0F, 0.01F);
  for (int i = 0; i < markers; ++i) out.put(std::int32_t{0});
  for (int i = 0; i < markers && version.major >= 4; ++i) out.text("Marker");
}

Bytes marker_set_definition() {
  return Writer().text("all").put(std::int32_t{2}).text("a").text("b").bytes();
}

Bytes skeleton_definition(Version version, bool with_markers) {
  Writer out;
  out.text("person").put(std::int32_t{9}).put(std::int32_t{2});
  body_definition(out, version, "hip", 1, with_markers ? 3 : -1);
  body_definition(out, version, "chest", 2, with_markers ? 0 : -1);
  return out.bytes();
}

Bytes force_plate_definition() {
  Writer out;
  out.put(std::int32_t{1})
      .text("serial")
      .put(0.5F)
      .put(0.4F)
      .vector(0, 0, 0)
      .zeros(12 * 12 * 4)
      .zeros(12 * 4);
  return out.put(std::int32_t{0}).put(std::int32_t{0}).put(std::int32_t{2}).text("Fx").text("Fy").bytes();
}

Bytes device_definition() {
  Writer out;
  out.put(std::int32_t{1}).text("analog").text("serial").put(std::int32_t{0}).put(std::int32_t{0});
  return out.put(std::int32_t{1}).text("channel").bytes();
}

}  // namespace

Bytes server_info(const Server& server) {
  Writer out;
  out.field(server.application, 256).put(std::uint8_t{3}).put(std::uint8_t{1}).zeros(2);
  out.put(static_cast<std::uint8_t>(server.version.major));
  out.put(static_cast<std::uint8_t>(server.version.minor)).zeros(2);
  out.put(server.clock_hz).put(server.data_port).put(static_cast<std::uint8_t>(server.multicast ? 1 : 0));
  for (const std::uint8_t byte : mocap::natnet::kMulticastGroup) out.put(byte);
  return message(1, out.bytes());
}

Bytes models(Version version, const std::vector<Body>& bodies, bool with_others, bool bones_with_markers) {
  Writer out;
  out.put(static_cast<std::int32_t>(bodies.size() + (with_others ? 5 : 0)));
  if (with_others) {
    definition(out, version, 0, marker_set_definition());
    definition(out, version, 2, skeleton_definition(version, bones_with_markers));
    definition(out, version, 3, force_plate_definition());
    definition(out, version, 4, device_definition());
    definition(out, version, 5, Writer().text("camera").zeros(28).bytes());
  }
  for (const Body& body : bodies) {
    Writer content;
    body_definition(content, version, body.name, body.id, body.markers);
    definition(out, version, 1, content.bytes());
  }
  return message(5, out.bytes());
}

Bytes frame(Version version, const Frame& frame) {
  const bool others = frame.with_others;
  Writer out;
  out.put(frame.number);
  section(out, version, others ? 1 : 0,
          others ? Writer().text("all").put(std::int32_t{1}).vector(1, 2, 3).bytes() : Bytes{});
  section(out, version, others ? 2 : 0, others ? Writer().vector(1, 2, 3).vector(4, 5, 6).bytes() : Bytes{});
  Writer bodies;
  for (const Body& body : frame.bodies) rigid_body(bodies, body);
  section(out, version, static_cast<std::int32_t>(frame.bodies.size()), bodies.bytes());
  Writer skeletons;
  if (others) {
    skeletons.put(std::int32_t{9}).put(std::int32_t{1});
    rigid_body(skeletons, {"hip", 1});
  }
  section(out, version, others ? 1 : 0, skeletons.bytes());
  if (has_sizes(version)) {
    Writer assets;
    if (others) {
      assets.put(std::int32_t{7}).put(std::int32_t{1});
      rigid_body(assets, {"part", 1});
      assets.put(std::int32_t{1})
          .put(std::int32_t{1})
          .vector(0, 0, 0)
          .put(0.01F)
          .put(std::int16_t{0})
          .put(0.0F);
    }
    section(out, version, others ? 1 : 0, assets.bytes());
  }
  Writer markers;
  std::int32_t count = 0;
  for (const Body& body : frame.bodies) {
    for (int i = 0; i < body.markers; ++i, ++count) {
      markers.put(static_cast<std::uint16_t>(i + 1)).put(static_cast<std::uint16_t>(body.id)).vector(0, 0, 0);
      markers.put(0.01F).put(static_cast<std::int16_t>(i < body.lost_markers ? 5 : 2)).put(0.0002F);
    }
  }
  section(out, version, count, markers.bytes());
  for (int kind = 0; kind < 2; ++kind) {
    Writer analog;
    if (others) analog_data(analog, kind + 1);
    section(out, version, others ? 1 : 0, analog.bytes());
  }
  out.zeros(8).put(12.5).put(frame.exposed_ticks).put(frame.received_ticks).put(frame.sent_ticks);
  if (has_sizes(version)) out.zeros(8);
  out.put(static_cast<std::int16_t>(frame.models_changed ? 2 : 0)).zeros(4);
  return message(7, out.bytes());
}

Bytes echo_response(std::uint64_t request, std::uint64_t received_ticks) {
  return message(13, Writer().put(request).put(received_ticks).bytes());
}

}  // namespace swiftlet::tests::natnet
