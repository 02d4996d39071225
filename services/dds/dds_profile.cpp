#include "swiftlet/services/dds/dds_profile.hpp"

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <string_view>
#include <tinyxml2.h>
#include <utility>
#include <vector>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"
#include "swiftlet/services/dds/fast_dds_library.hpp"

namespace swiftlet::comms {
namespace {

namespace dds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using Element = tinyxml2::XMLElement;

constexpr const char* kUseBuiltinTransports = "useBuiltinTransports";
constexpr const char* kUserTransports = "userTransports";
constexpr const char* kTransportId = "transport_id";

// The errors of Fast DDS while it reads a file. Its warnings do not make a file wrong.
class ErrorCollector final : public dds::LogConsumer {
 public:
  explicit ErrorCollector(std::vector<std::string>& errors) : errors_(errors) {}
  void Consume(const dds::Log::Entry& entry) override {
    if (entry.kind == dds::Log::Kind::Error) errors_.push_back(entry.message);
  }

 private:
  std::vector<std::string>& errors_;
};

class ProfileFile {
 public:
  explicit ProfileFile(const std::string& file) : file_(file) {
    const std::string text = runtime::read_text_file(file);
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
      throw runtime::ConfigError(file, document_.ErrorLineNum(), "",
                                 std::string("is no valid XML: ") + document_.ErrorName());
  }

  // The name of the participant profile, after checking all that the file sets.
  std::string checked_profile() const {
    const Element& profiles = all_profiles();
    require_known(profiles, {"transport_descriptors", "participant"});
    const Element& participant = chosen_participant(profiles);
    require_known(participant, {"rtps"});
    if (const Element* const rtps = participant.FirstChildElement("rtps")) check_participant(profiles, *rtps);
    return participant.Attribute("profile_name");
  }

 private:
  [[noreturn]] void fail(const Element& at, const std::string& message) const {
    throw runtime::ConfigError(file_, at.GetLineNum(), std::string("<") + at.Name() + ">", message);
  }

  void require_known(const Element& parent, std::initializer_list<std::string_view> names) const {
    std::string list;
    for (const std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
    for (const Element* it = parent.FirstChildElement(); it != nullptr; it = it->NextSiblingElement()) {
      if (std::find(names.begin(), names.end(), it->Name()) == names.end())
        fail(*it, "may not be set: Swiftlet sets it, or ignores it; of <" + std::string(parent.Name()) +
                      "> a profile may set " + list);
    }
  }

  const Element& all_profiles() const {
    const Element* const root = document_.RootElement();
    if (root == nullptr) throw runtime::ConfigError(file_, 0, "", "must be <dds> with <profiles>");
    if (std::string_view(root->Name()) == "profiles") return *root;
    const Element* const profiles = root->FirstChildElement("profiles");
    if (std::string_view(root->Name()) != "dds" || profiles == nullptr)
      fail(*root, "must be <dds> with <profiles>");
    require_known(*root, {"profiles"});
    return *profiles;
  }

  // The only one, or the default one.
  const Element& chosen_participant(const Element& profiles) const {
    const Element* chosen = nullptr;
    int count = 0;
    const char* const tag = "participant";
    for (const Element* it = profiles.FirstChildElement(tag); it != nullptr;
         it = it->NextSiblingElement(tag)) {
      if (it->Attribute("profile_name") == nullptr) fail(*it, "has no profile_name");
      if (chosen == nullptr || it->BoolAttribute("is_default_profile")) chosen = it;
      ++count;
    }
    if (chosen == nullptr) fail(profiles, "has no <participant>");
    if (count > 1 && !chosen->BoolAttribute("is_default_profile"))
      fail(profiles, R"(has several <participant>, of which none has is_default_profile="true")");
    return *chosen;
  }

  void check_participant(const Element& profiles, const Element& rtps) const {
    // No flow controllers, see kHasFlowControllers; those of 2.9 may end the process with a failed assertion.
    require_known(rtps, {"allocation", "sendSocketBufferSize", "listenSocketBufferSize", "propertiesPolicy",
                         kUserTransports, kUseBuiltinTransports});
    const Element* const builtin = rtps.FirstChildElement(kUseBuiltinTransports);
    if (builtin != nullptr && builtin->BoolText(false)) fail(*builtin, "is true, must be false");
    const Element* const transports = rtps.FirstChildElement(kUserTransports);
    if (transports == nullptr) return;
    const Element* const id = transports->FirstChildElement(kTransportId);
    if (id == nullptr || id->NextSiblingElement() != nullptr) fail(*transports, "must name one transport_id");
    check_transport(profiles, *id);
  }

  void check_transport(const Element& profiles, const Element& id) const {
    const std::string wanted = id.GetText() == nullptr ? "" : id.GetText();
    const Element* const list = profiles.FirstChildElement("transport_descriptors");
    const Element* it = list == nullptr ? nullptr : list->FirstChildElement("transport_descriptor");
    for (; it != nullptr; it = it->NextSiblingElement("transport_descriptor")) {
      if (text_of(*it, kTransportId) != wanted) continue;
      if (text_of(*it, "type") != "UDPv4")
        fail(*it, "is of type " + text_of(*it, "type") + ", must be UDPv4");
      require_known(*it, {kTransportId, "type", "sendBufferSize", "receiveBufferSize", "TTL",
                          "maxMessageSize", "output_port", "interfaceWhiteList"});
      return;
    }
    fail(id, "is '" + wanted + "', must be the transport_id of a <transport_descriptor>");
  }

  static std::string text_of(const Element& parent, const char* child) {
    const Element* const element = parent.FirstChildElement(child);
    return element == nullptr || element->GetText() == nullptr ? "" : element->GetText();
  }

  std::string file_;
  tinyxml2::XMLDocument document_;
};

// Throws with the first error of Fast DDS, which names the element.
void load_into_fast_dds(const std::string& file) {
  std::vector<std::string> errors;
  dds::Log::Flush();
  dds::Log::ClearConsumers();
  dds::Log::RegisterConsumer(std::make_unique<ErrorCollector>(errors));
  const ReturnCode loaded = dds::DomainParticipantFactory::get_instance()->load_XML_profiles_file(file);
  dds::Log::Flush();
  log_fast_dds();
  if (!succeeded(loaded) || !errors.empty())
    throw runtime::ConfigError(file, 0, "",
                               "is refused by Fast DDS: " + (errors.empty() ? "" : errors.front()));
}

}  // namespace

DdsProfile load_dds_profile(const std::string& file) {
  static std::mutex mutex;  // Fast DDS has one log and one list of profiles
  const std::lock_guard<std::mutex> lock(mutex);
  set_up_fast_dds();
  const std::string name = ProfileFile(file).checked_profile();
  load_into_fast_dds(file);
  DdsProfile profile;
  dds::DomainParticipantFactory::get_instance()->get_participant_qos_from_profile(name, profile.participant);
  auto& transports = profile.participant.transport().user_transports;
  if (!transports.empty()) profile.udp = dynamic_cast<const UDPv4TransportDescriptor&>(*transports.front());
  transports.clear();
  // The sizes of the participant are those of its transport, unless that has its own.
  const auto& sizes = profile.participant.transport();
  if (profile.udp.sendBufferSize == 0) profile.udp.sendBufferSize = sizes.send_socket_buffer_size;
  if (profile.udp.receiveBufferSize == 0) profile.udp.receiveBufferSize = sizes.listen_socket_buffer_size;
  return profile;
}

}  // namespace swiftlet::comms
