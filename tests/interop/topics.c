#include "topics.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dds/ddsi/ddsi_serdata.h"
#include "services/messages/topic_table.hpp"

#define TOPIC(type, name, profile, ...) {name, &swiftlet_msgs_msg_dds__##type##__desc, profile},
#define TOPIC_OF(type, constant, ...) TOPIC(type, __VA_ARGS__)

const topic_t topics[] = {SWIFTLET_TOPICS(TOPIC, TOPIC_OF)};
const size_t topic_count = sizeof topics / sizeof topics[0];

void fail(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vfprintf(stderr, format, arguments);
  va_end(arguments);
  fputc('\n', stderr);
  exit(1);
}

const topic_t* find_topic(const char* name) {
  for (size_t i = 0; i < topic_count; ++i) {
    if (strcmp(topics[i].name, name) == 0) return &topics[i];
  }
  return NULL;
}

static dds_qos_t* qos_of(profile_t profile) {
  dds_qos_t* qos = dds_create_qos();
  const bool reliable = profile != Stream && profile != Telemetry;
  dds_qset_reliability(qos, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_SECS(1));
  if (profile == Latched || profile == LatchedLarge || profile == Reply) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  if (profile == Request || profile == Reply)
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  else
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  return qos;
}

static dds_entity_t topic_in(dds_entity_t participant, const char* vehicle, const topic_t* topic) {
  char name[256];
  snprintf(name, sizeof name, "rt/%s/%s", vehicle, topic->name);
  const dds_entity_t found = dds_find_topic(DDS_FIND_SCOPE_PARTICIPANT, participant, name, NULL, 0);
  const dds_entity_t entity = found > 0 ? found : dds_create_topic(participant, topic->type, name, NULL, NULL);
  if (entity < 0) fail("%s: no topic: %s", name, dds_strretcode(entity));
  return entity;
}

static dds_qos_t* sensor_data_qos(void) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 5);
  return qos;
}

dds_entity_t create_reader(dds_entity_t participant, const char* vehicle, const topic_t* topic, reader_qos_t wanted) {
  dds_qos_t* qos = wanted == SENSOR_DATA ? sensor_data_qos() : qos_of(topic->profile);
  const dds_entity_t reader = dds_create_reader(participant, topic_in(participant, vehicle, topic), qos, NULL);
  dds_delete_qos(qos);
  if (reader < 0) fail("%s: no reader: %s", topic->name, dds_strretcode(reader));
  return reader;
}

dds_entity_t create_writer(dds_entity_t participant, const char* vehicle, const topic_t* topic) {
  dds_qos_t* qos = qos_of(topic->profile);
  const dds_entity_t writer = dds_create_writer(participant, topic_in(participant, vehicle, topic), qos, NULL);
  dds_delete_qos(qos);
  if (writer < 0) fail("%s: no writer: %s", topic->name, dds_strretcode(writer));
  return writer;
}

static void check_payload(const topic_t* topic, struct ddsi_serdata* received, const void* message) {
  struct ddsi_serdata* encoded = ddsi_serdata_from_sample(received->type, SDK_DATA, message);
  if (encoded == NULL) fail("%s: the message cannot be encoded again", topic->name);
  const uint32_t size = ddsi_serdata_size(received);
  const uint32_t padded = (size + 3) / 4 * 4;  // Cyclone DDS fills the last four bytes
  if (ddsi_serdata_size(encoded) != padded)
    fail("%s: the payload has %u bytes, encoded again it has %u", topic->name, size, ddsi_serdata_size(encoded));
  unsigned char* bytes = malloc(2 * (size_t)size);
  ddsi_serdata_to_ser(received, 0, size, bytes);
  ddsi_serdata_to_ser(encoded, 0, size, bytes + size);
  const uint32_t header = 4;  // encapsulation; its last two bytes are options, which vendors use differently
  for (uint32_t i = header; i < size; ++i) {
    if (bytes[i] != bytes[size + i] && bytes[size + i] != 0)
      fail("%s: byte %u of the payload is %u, encoded again it is %u", topic->name, i, bytes[i], bytes[size + i]);
  }
  free(bytes);
  ddsi_serdata_unref(encoded);
}

void* take(dds_entity_t reader, const topic_t* topic) {
  struct ddsi_serdata* received = NULL;
  dds_sample_info_t info;
  void* message = NULL;
  while (message == NULL && dds_takecdr(reader, &received, 1, &info, DDS_ANY_STATE) == 1) {
    if (info.valid_data) {
      message = dds_alloc(topic->type->m_size);
      memset(message, 0, topic->type->m_size);
      if (!ddsi_serdata_to_sample(received, message, NULL, NULL)) fail("%s: a sample cannot be decoded", topic->name);
      check_payload(topic, received, message);
    }
    ddsi_serdata_unref(received);
  }
  return message;
}
