// The QoS profiles in terms of Fast DDS.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::dds {

// True if late joiners receive the last sample (durability transient local).
bool is_latched(messages::Qos profile);
bool is_reliable(messages::Qos profile);

// Sends the fragments of long messages: each fits into a frame of Ethernet, so that a lost frame costs one fragment, and a
// long message does not fill the buffers on the way. For participants with kHasFlowControllers; without, only the size of
// the fragments is limited.
std::shared_ptr<eprosima::fastdds::rtps::FlowControllerDescriptor> long_message_flow();

eprosima::fastdds::dds::DataWriterQos writer_qos(messages::Qos profile);
eprosima::fastdds::dds::DataReaderQos reader_qos(messages::Qos profile);

// States the type hash of an endpoint in its user data, where ROS 2 looks for it, as rmw_dds_common encodes it. hash: may be null.
template <class EndpointQos>
void state_type_hash(EndpointQos& qos, const char* hash) {
  if (hash == nullptr) return;
  const std::string text = "typehash=" + std::string(hash) + ";";
  qos.user_data().data_vec(std::vector<std::uint8_t>(text.begin(), text.end()));
}

}  // namespace swiftlet::dds
