#include "swiftlet/services/dds/dds_profile.hpp"

#include <string_view>
#include <tinyxml2.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::dds {
namespace {

namespace fastdds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

// The name of the participant profile: of the first, or of that with is_default_profile="true".
std::string participant_profile(const std::string& file) {
  tinyxml2::XMLDocument document;
  const std::string text = io::read_text_file(file);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw io::ConfigError(file, document.ErrorLineNum(), "",
                          std::string("is no valid XML: ") + document.ErrorName());
  const tinyxml2::XMLElement* profiles = document.RootElement();
  if (profiles != nullptr && std::string_view(profiles->Name()) != "profiles")
    profiles = profiles->FirstChildElement("profiles");
  const char* name = nullptr;
  const char* const tag = "participant";
  const tinyxml2::XMLElement* it = profiles == nullptr ? nullptr : profiles->FirstChildElement(tag);
  for (; it != nullptr; it = it->NextSiblingElement(tag)) {
    if (name == nullptr || it->BoolAttribute("is_default_profile")) name = it->Attribute("profile_name");
  }
  if (name == nullptr)
    throw io::ConfigError(file, 0, "",
                          "must be <dds> with <profiles> and in it a <participant profile_name=...>");
  return name;
}

}  // namespace

DdsProfile load_dds_profile(const std::string& file) {
  const std::string name = participant_profile(file);
  auto* const factory = fastdds::DomainParticipantFactory::get_instance();
  fastdds::DomainParticipantQos of_file;
  if (!succeeded(factory->load_XML_profiles_file(file)) ||
      !succeeded(factory->get_participant_qos_from_profile(name, of_file)))
    throw io::ConfigError(file, 0, "", "is refused by Fast DDS: see its error above");
  DdsProfile profile;
  profile.participant.allocation(of_file.allocation());
  profile.participant.properties(of_file.properties());
  const auto& transports = of_file.transport().user_transports;
  if (!transports.empty()) {
    const auto* const udp = dynamic_cast<const UDPv4TransportDescriptor*>(transports.front().get());
    if (udp == nullptr)
      throw io::ConfigError(file, 0, "<userTransports>", "must name a transport of type UDPv4");
    profile.udp = *udp;
  }
  // The sizes of the participant are those of its transport, unless that has its own.
  const auto& sizes = of_file.transport();
  profile.participant.transport().send_socket_buffer_size = sizes.send_socket_buffer_size;
  profile.participant.transport().listen_socket_buffer_size = sizes.listen_socket_buffer_size;
  if (profile.udp.sendBufferSize == 0) profile.udp.sendBufferSize = sizes.send_socket_buffer_size;
  if (profile.udp.receiveBufferSize == 0) profile.udp.receiveBufferSize = sizes.listen_socket_buffer_size;
  return profile;
}

}  // namespace swiftlet::dds
