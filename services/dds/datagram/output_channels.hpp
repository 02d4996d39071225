// How a transport of Fast DDS puts channels of its own before those of the transport below it.
#pragma once

#include <memory>
#include <utility>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// Lets the transport below open a channel for a locator. It recognizes the channels that it opened before only if they are
// not wrapped, and would open a second one and send everything twice: they are unwrapped meanwhile. channels: all of the calling
// transport, since a participant has no other. wrap(channel) returns the channel to put before one of the transport below.
template <class Wrap>
bool open_below(eprosima::fastdds::rtps::TransportInterface& below,
                eprosima::fastdds::rtps::SendResourceList& channels, const rtps::Locator_t& locator,
                const Wrap& wrap) {
  eprosima::fastdds::rtps::SendResourceList unwrapped;
  for (auto& channel : channels) unwrapped.push_back(static_cast<OutputChannel&>(*channel).take());
  const bool opened = below.OpenOutputChannel(unwrapped, locator);
  channels.clear();
  for (auto& channel : unwrapped) channels.push_back(wrap(std::move(channel)));
  return opened;
}

}  // namespace swiftlet::comms
