// How a transport of Fast DDS puts channels of its own before those of the transport below it.
#pragma once

#include <memory>
#include <utility>

#include "swiftlet/services/dds/fast_dds.hpp"

namespace swiftlet::comms {

// Lets the transport below open a channel for a locator. It recognizes the channels that it opened before only if they are
// not wrapped, and would open a second one and send everything twice: those that is_own(channel) says to be of the calling
// transport are unwrapped meanwhile. wrap(channel) returns the channel to put before one of the transport below.
template <class Channel, class IsOwn, class Wrap>
bool open_below(eprosima::fastdds::rtps::TransportInterface& below,
                eprosima::fastdds::rtps::SendResourceList& channels, const rtps::Locator_t& locator,
                const IsOwn& is_own, const Wrap& wrap) {
  eprosima::fastdds::rtps::SendResourceList unwrapped;
  eprosima::fastdds::rtps::SendResourceList others;
  for (auto& channel : channels) {
    auto* const own = dynamic_cast<Channel*>(channel.get());
    if (own != nullptr && is_own(*own)) {
      unwrapped.push_back(own->take());
    } else {
      others.push_back(std::move(channel));
    }
  }
  const bool opened = below.OpenOutputChannel(unwrapped, locator);
  channels = std::move(others);
  for (auto& channel : unwrapped) channels.push_back(wrap(std::move(channel)));
  return opened;
}

}  // namespace swiftlet::comms
