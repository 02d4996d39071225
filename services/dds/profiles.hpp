// The QoS profiles as Fast DDS states them.
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// A late joiner is told the last sample.
bool is_kept(Qos profile);

eprosima::fastdds::dds::DataWriterQos writer_qos(Qos profile, int deadline_ms, std::uint32_t strength,
                                                 Transport transport);
eprosima::fastdds::dds::DataReaderQos reader_qos(Qos profile, int deadline_ms, Transport transport,
                                                 Delivery delivery);

}  // namespace swiftlet::comms
