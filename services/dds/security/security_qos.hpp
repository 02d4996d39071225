// Turns DDS Security on for a participant, with the builtin plugins of Fast DDS.
#pragma once

#include <string>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

namespace swiftlet::dds {

// The role of a process with this name (NodeSettings::name) in the folder: plant, mocap and control have theirs,
// `swiftlet check vehicle` commands as control; tools are ground, or observer if the folder has no ground.
std::string security_role(const std::string& folder, const std::string& process);

// Why a process cannot join with the folder, a sentence; empty if it can.
std::string fault_of_security(const std::string& folder, const std::string& process);

// Throws std::runtime_error with that sentence.
void set_security(const std::string& folder, const std::string& process,
                  eprosima::fastdds::dds::DomainParticipantQos& qos);

}  // namespace swiftlet::dds
