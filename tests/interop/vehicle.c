#include "vehicle.h"

#include <string.h>

void join(vehicle_t* vehicle, int domain, const char* name, int seconds, reader_qos_t qos) {
  memset(vehicle, 0, sizeof *vehicle);
  vehicle->deadline = dds_time() + DDS_SECS(seconds);
  vehicle->client = (uint64_t)dds_time() | 1;
  vehicle->participant = dds_create_participant((dds_domainid_t)domain, NULL, NULL);
  if (vehicle->participant < 0) fail("no participant: %s", dds_strretcode(vehicle->participant));
  vehicle->waitset = dds_create_waitset(vehicle->participant);
  for (size_t i = 0; i < topic_count; ++i) {
    vehicle->readers[i] = create_reader(vehicle->participant, name, &topics[i], qos);
    dds_set_status_mask(vehicle->readers[i], DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(vehicle->waitset, vehicle->readers[i], (dds_attach_t)i);
  }
}

void leave(vehicle_t* vehicle) {
  for (size_t i = 0; i < topic_count; ++i) {
    if (vehicle->newest[i] != NULL) dds_sample_free(vehicle->newest[i], topics[i].type, DDS_FREE_ALL);
  }
  dds_delete(vehicle->participant);
}

void pump(vehicle_t* vehicle, const char* waiting_for) {
  if (dds_time() > vehicle->deadline) fail("waited in vain for %s", waiting_for);
  dds_attach_t triggered[MOST_TOPICS];
  dds_waitset_wait(vehicle->waitset, triggered, MOST_TOPICS, DDS_MSECS(20));
  for (size_t i = 0; i < topic_count; ++i) {
    void* message;
    while ((message = take(vehicle->readers[i], &topics[i])) != NULL) {
      if (vehicle->newest[i] != NULL) dds_sample_free(vehicle->newest[i], topics[i].type, DDS_FREE_ALL);
      vehicle->newest[i] = message;
      ++vehicle->counts[i];
    }
  }
}

static size_t index_of(const char* topic) {
  const topic_t* found = find_topic(topic);
  if (found == NULL) fail("%s: no such topic", topic);
  return (size_t)(found - topics);
}

const void* newest(const vehicle_t* vehicle, const char* topic) { return vehicle->newest[index_of(topic)]; }
uint64_t count(const vehicle_t* vehicle, const char* topic) { return vehicle->counts[index_of(topic)]; }
