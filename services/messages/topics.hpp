// The topics of a vehicle as constants of their message types: topics::kImu.
#pragma once

#include <string_view>

#include "swiftlet_msgs/msg/types.h"

#include "swiftlet/services/messages/qos.hpp"
#include "swiftlet/services/messages/topic_roles.hpp"
#include "swiftlet/services/messages/topic_table.hpp"

namespace swiftlet::messages {

namespace msg = swiftlet_msgs::msg;

template <class T>
struct Topic {
  using Message = T;
  const char* name;
  Qos qos;
  std::string_view writers[2]{};  // roles; empty: none
};

namespace topics {
#define SWIFTLET_TOPIC_OF(Type, Constant, name, profile, ...) \
  inline constexpr Topic<msg::Type> k##Constant{name, Qos::k##profile, {__VA_ARGS__}};
#define SWIFTLET_TOPIC(Type, ...) SWIFTLET_TOPIC_OF(Type, Type, __VA_ARGS__)
SWIFTLET_TOPICS(SWIFTLET_TOPIC, SWIFTLET_TOPIC_OF)
#undef SWIFTLET_TOPIC
#undef SWIFTLET_TOPIC_OF
}  // namespace topics

// The topic of a message, if its type has several the one that is named like it.
#define SWIFTLET_TOPIC(Type, ...) \
  constexpr const Topic<msg::Type>& topic_of(const msg::Type&) { return topics::k##Type; }
#define SWIFTLET_TOPIC_OF(...)
SWIFTLET_TOPICS(SWIFTLET_TOPIC, SWIFTLET_TOPIC_OF)
#undef SWIFTLET_TOPIC
#undef SWIFTLET_TOPIC_OF

// Calls use(topic) with each Topic<T>.
template <class Use>
void for_each_topic(const Use& use) {
#define SWIFTLET_USE_TOPIC(Type, ...) use(topics::k##Type);
#define SWIFTLET_USE_TOPIC_OF(Type, Constant, ...) use(topics::k##Constant);
  SWIFTLET_TOPICS(SWIFTLET_USE_TOPIC, SWIFTLET_USE_TOPIC_OF)
#undef SWIFTLET_USE_TOPIC
#undef SWIFTLET_USE_TOPIC_OF
}

}  // namespace swiftlet::messages
