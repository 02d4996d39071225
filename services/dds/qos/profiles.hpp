// The QoS profiles in terms of Fast DDS.
#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::comms {

// True if late joiners receive the last sample (durability transient local).
bool is_latched(Qos profile);

eprosima::fastdds::dds::DataWriterQos writer_qos(Qos profile, int deadline_ms, std::uint32_t strength,
                                                 Transport transport);
eprosima::fastdds::dds::DataReaderQos reader_qos(Qos profile, int deadline_ms, Transport transport,
                                                 Delivery delivery);

}  // namespace swiftlet::comms
