#include "swiftlet/ground/ros/ros_messages.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "swiftlet/ground/ros/raw_type.hpp"
#include "swiftlet/services/dds/endpoints.hpp"

namespace swiftlet::dds {

template <class Type>
struct PubSubTypeOf<ros::Message<Type>> {
  using type = ros::RawType<Type>;
};

template <class Type>
struct RosTypeHash<ros::Message<Type>> {
  static const char* value() { return Type::kTypeHash; }
};

}  // namespace swiftlet::dds

namespace swiftlet::ros {
namespace {

// "geometry_msgs/msg/PoseStamped" as it is on the wire.
std::string wire_type(const std::string& ros_type) {
  const std::string separator = "/msg/";
  const std::size_t at = ros_type.find(separator);
  return ros_type.substr(0, at) + "::msg::dds_::" + ros_type.substr(at + separator.size()) + "_";
}

template <class... Types>
struct WriterOfAny {
  static Writer make(dds::Node& node, const std::string& name, const std::string& type) {
    Writer made;
    const auto make_if = [&](auto tag, bool is_it) {
      // A path is longer than what the other profile sends in one piece.
      constexpr bool kLong = std::is_same_v<decltype(tag), Path>;
      if (is_it)
        made =
            writer<decltype(tag)>(node, name, kLong ? messages::Qos::kLatchedLarge : messages::Qos::kLatched);
    };
    (make_if(Types{}, type == Types::kName), ...);
    if (!made) throw std::logic_error("no writer of " + type);
    return made;
  }
};

}  // namespace

template <class Type>
Writer writer(dds::Node& node, const std::string& name, messages::Qos qos) {
  struct Named {
    std::string name;
    dds::Publisher<Message<Type>> publisher;
  };
  const auto named = std::make_shared<Named>(Named{name, {}});
  named->publisher = node.publish(messages::Topic<Message<Type>>{named->name.c_str(), qos});
  return [named](Bytes payload) { return named->publisher.publish({std::move(payload)}); };
}

Writer writer_of(dds::Node& node, const std::string& name, const std::string& ros_type) {
  return WriterOfAny<PoseStamped, Path, Odometry, Imu, BatteryState, Transforms>::make(node, name,
                                                                                       wire_type(ros_type));
}

template <class Type>
Reader<Type>::Reader(dds::Node& node, const std::string& name, messages::Qos qos,
                     std::function<void(const Bytes&)> callback)
    : name_(std::make_unique<const std::string>(name)),
      subscription_(node.subscribe<Message<Type>>(
          messages::Topic<Message<Type>>{name_->c_str(), qos},
          [callback = std::move(callback)](const Message<Type>& message) { callback(message.payload); })) {}

template Writer writer<Clock>(dds::Node&, const std::string&, messages::Qos);
template class Reader<PoseStamped>;
template class Reader<Twist>;

}  // namespace swiftlet::ros
