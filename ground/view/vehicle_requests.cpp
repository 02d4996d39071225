#include "swiftlet/ground/view/vehicle_requests.hpp"

#include <array>
#include <chrono>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "swiftlet/record/file/cdr_writer.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

struct Kind {
  const char* name;
  bool confirmed;  // needs `true` in the request
  ActionHandle (*send)(Vehicle&);
};
constexpr std::array<Kind, 3> kKinds = {{
    {"hold", false, [](Vehicle& vehicle) { return vehicle.hold(); }},
    {"land", false, [](Vehicle& vehicle) { return vehicle.land(); }},
    {"stop", true, [](Vehicle& vehicle) { return vehicle.stop(); }},
}};
constexpr const char* kResponse = "bool success\nstring message\n";
constexpr std::size_t kCdrHead = 4;  // the encapsulation header

foxglove::Service service_of(std::size_t id, const std::string& vehicle, const Kind& kind) {
  const std::string type = kind.confirmed ? "std_srvs/srv/SetBool" : "std_srvs/srv/Trigger";
  return {static_cast<std::uint32_t>(id),
          "/" + vehicle + "/" + kind.name,
          type,
          type + "_Request",
          kind.confirmed ? "bool data\n" : "",
          type + "_Response",
          kResponse};
}

}  // namespace

VehicleRequests::~VehicleRequests() { ending_ = true; }

void VehicleRequests::add_vehicle(const std::string& name) {
  vehicles_.push_back(std::make_unique<Vehicle>(context_, name, Telemetry::kNotReceived));
  vehicles_.back()->cancel_when([this] { return ending_.load(); });
  for (const Kind& kind : kKinds) services_.push_back(service_of(services_.size(), name, kind));
}

std::string VehicleRequests::call(const foxglove::ServiceCall& call,
                                  std::function<void(const Answer&)> done) {
  if (call.service >= services_.size()) return fmt::format("there is no service {}", call.service);
  if (call.encoding != "cdr") return "the encoding of the request must be cdr";
  const std::size_t number = call.service % kKinds.size();
  const Kind& kind = kKinds.at(number);
  std::list<std::future<void>>& under_way = under_way_.at(number);
  if (kind.confirmed && (call.request.size() <= kCdrHead || call.request[kCdrHead] != 1))
    return fmt::format("{} is not confirmed: data must be true", kind.name);
  under_way.remove_if(
      [](const std::future<void>& one) { return one.wait_for(0s) == std::future_status::ready; });
  if (under_way.size() >= kMostUnderWay)
    return fmt::format("{} requests to {} wait for their answers, which is the most", under_way.size(),
                       kind.name);
  Vehicle& vehicle = *vehicles_[call.service / kKinds.size()];
  try {
    under_way.push_back(std::async(std::launch::async, [&vehicle, &kind, done = std::move(done)] {
      const Result answer = kind.send(vehicle).answer();
      done({answer.accepted(), answer.reason});
    }));
  } catch (const std::system_error& error) {
    return fmt::format("{} was not sent: {}", kind.name, error.what());
  }
  return "";
}

mcap::Bytes to_response(const VehicleRequests::Answer& answer) {
  record::CdrWriter out;
  out.put(std::uint8_t{answer.accepted}).text(answer.reason);
  return out.take();
}

}  // namespace swiftlet::ground
