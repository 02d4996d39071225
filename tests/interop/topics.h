// The topics of a vehicle as Cyclone DDS sees them: name, type, QoS.
#ifndef SWIFTLET_INTEROP_TOPICS_H
#define SWIFTLET_INTEROP_TOPICS_H

#include <stddef.h>

#include "dds/dds.h"
#include "swiftlet_msgs.h"

typedef enum { Stream, Telemetry, Latched, LatchedLarge, Request, Reply } profile_t;  // as in idl/README.md

typedef struct {
  const char* name;
  const dds_topic_descriptor_t* type;
  profile_t profile;
} topic_t;

extern const topic_t topics[];
extern const size_t topic_count;

const topic_t* find_topic(const char* name);  // NULL if there is none

// That of the topic's profile, or the one that ROS 2 has for sensor data, which every topic must match.
typedef enum { OF_TOPIC, SENSOR_DATA } reader_qos_t;

// Of rt/<vehicle>/<name>. Ends the process if it cannot be created.
dds_entity_t create_reader(dds_entity_t participant, const char* vehicle, const topic_t* topic, reader_qos_t qos);
dds_entity_t create_writer(dds_entity_t participant, const char* vehicle, const topic_t* topic);

// Takes the next sample as the message that the topic's type says, allocated; NULL if there is none. The message is encoded
// again: its payload must have the length of the received one, and equal it but for bytes that are padding, which are 0 in the
// new one; otherwise the process ends. The caller frees it with dds_sample_free(message, topic->type, DDS_FREE_ALL).
void* take(dds_entity_t reader, const topic_t* topic);

// Prints a sentence to stderr and ends the process with exit code 1.
_Noreturn void fail(const char* format, ...);

#endif
