// The generated type supports of all messages.
#pragma once

#include "swiftlet_msgs/msg/pub_sub_types.h"

#include "swiftlet/services/messages/topics.hpp"

// Calls X(type, ...) for each message type of topics, once.
#define SWIFTLET_NO_FURTHER_TYPE(...)
#define SWIFTLET_FOR_EACH_MESSAGE(X) SWIFTLET_TOPICS(X, SWIFTLET_NO_FURTHER_TYPE)

namespace swiftlet::dds {

template <class T>
struct PubSubTypeOf;
#define SWIFTLET_PUB_SUB_TYPE(Name, ...)          \
  template <>                                     \
  struct PubSubTypeOf<messages::msg::Name> {      \
    using type = messages::msg::Name##PubSubType; \
  };
SWIFTLET_FOR_EACH_MESSAGE(SWIFTLET_PUB_SUB_TYPE)
#undef SWIFTLET_PUB_SUB_TYPE

}  // namespace swiftlet::dds
