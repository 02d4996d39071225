// The message types as ROS 2 message definitions, for recorded flights. Generated from the IDL files by idl/ros2msg.py.
#pragma once

namespace swiftlet::messages {

struct MessageSchema {
  const char* name;        // "swiftlet_msgs/msg/Imu"
  const char* definition;  // with those of the types that it uses, as a ros2msg schema of an MCAP file
  int stamp_offset;        // of stamp_ns in the payload, with the encapsulation header; -1: it has none
  const char* type_hash =
      nullptr;  // by which ROS 2 knows the type, "RIHS01_..." (REP 2016); null: not stated here
};

template <class T>
const MessageSchema& schema_of();

}  // namespace swiftlet::messages
