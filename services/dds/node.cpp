#include "swiftlet/services/dds/node.hpp"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "swiftlet/io/text.hpp"
#include "swiftlet/services/dds/endpoints.hpp"
#include "swiftlet/services/dds/message_types.hpp"
#include "swiftlet/services/dds/participant.hpp"
#include "swiftlet/services/messages/schemas.hpp"
#include "swiftlet/services/messages/vehicle_names.hpp"

namespace swiftlet::dds {

#define SWIFTLET_TYPE_HASH(Name, ...)                                                           \
  template <>                                                                                   \
  struct RosTypeHash<messages::msg::Name> {                                                     \
    static const char* value() { return messages::schema_of<messages::msg::Name>().type_hash; } \
  };
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_TYPE_HASH)
#undef SWIFTLET_TYPE_HASH

namespace {

const std::string& checked(const std::string& vehicle) {
  const std::string fault = messages::fault_of_vehicle_name(vehicle);
  if (!fault.empty()) throw std::runtime_error("vehicle name is '" + vehicle + "', " + fault);
  return vehicle;
}

}  // namespace

std::string ProcessIdentity::to_string() const {
  const std::string program = name.empty() ? "an unnamed program" : name;
  return host.empty() ? program : program + " (process " + std::to_string(pid) + " on host " + host + ")";
}

Participant::Participant(const NodeSettings& settings) : impl_(std::make_shared<Impl>(settings, "")) {}

Participant::Participant(const NodeSettings& settings, const std::vector<std::string>& vehicles)
    : impl_(std::make_shared<Impl>(settings, io::joined(vehicles, ","))) {}

Node::Node(const NodeSettings& settings)
    : participant_(std::make_shared<Participant::Impl>(settings, checked(settings.vehicle))),
      vehicle_(settings.vehicle),
      source_of_(settings.source_of) {}

Node::Node(const Participant& participant, const std::string& vehicle,
           std::function<void(const std::string&)> on_fault)
    : participant_(participant),
      vehicle_(checked(vehicle)),
      on_fault_(std::move(on_fault)),
      shares_participant_(true) {
  participant_.impl_->serve(vehicle_);
}

Node::~Node() {
  on_peer({});
  if (shares_participant_) participant_.impl_->stop_serving(vehicle_);
}

std::vector<std::string> Participant::topics_seen() const { return impl_->topics_seen(); }
std::vector<ProcessIdentity> Participant::processes_seen() const { return impl_->processes_seen(); }
std::vector<std::string> Participant::mismatches_seen() const { return impl_->mismatches_seen(); }
std::vector<std::string> Participant::refused_keys() const { return impl_->refused_keys(); }

std::optional<std::string> Participant::become_source(const std::vector<std::string>& excluded,
                                                      std::function<void(const std::string&)> on_lost) {
  return impl_->become_source(excluded, std::move(on_lost));
}

std::optional<std::string> Node::become_source(std::function<void(const std::string&)> on_lost) {
  if (source_of_.empty()) throw std::logic_error("become_source: NodeSettings::source_of is empty");
  return participant_.become_source({source_of_}, std::move(on_lost));
}

void Node::on_peer(std::function<void(const PeerEvent&)> callback) {
  participant_.impl_->listen(this, vehicle_, std::move(callback));
}

std::vector<std::string> Node::mismatches_seen() const {
  std::vector<std::string> all = participant_.mismatches_seen();
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const std::string& one) {
                             return one.rfind("rt/" + vehicle_ + "/", 0) != 0 &&
                                    one.rfind(vehicle_ + "/", 0) != 0;
                           }),
            all.end());
  return all;
}

void Node::rejoin() { participant_.impl_->rejoin(); }

#define SWIFTLET_INSTANTIATE(Name, ...)                                                               \
  template Publisher<messages::msg::Name> Node::publish(const messages::Topic<messages::msg::Name>&); \
  template Subscription Node::subscribe(const messages::Topic<messages::msg::Name>&,                  \
                                        std::function<void(const messages::msg::Name&)>, Delivery,    \
                                        std::optional<OneSource>);                                    \
  template Subscription Node::subscribe_raw(const messages::Topic<messages::msg::Name>&,              \
                                            std::function<void(const RawSample&)>, Delivery);
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_INSTANTIATE)
#undef SWIFTLET_INSTANTIATE

}  // namespace swiftlet::dds
