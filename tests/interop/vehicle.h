// A vehicle as a client of Cyclone DDS has it: readers of all topics, writers of the requests.
#ifndef SWIFTLET_INTEROP_VEHICLE_H
#define SWIFTLET_INTEROP_VEHICLE_H

#include "topics.h"

enum { MOST_TOPICS = 32 };

typedef struct {
  dds_entity_t participant, waitset;
  dds_entity_t readers[MOST_TOPICS];  // in the order of `topics`
  uint64_t counts[MOST_TOPICS];       // decoded samples of each
  void* newest[MOST_TOPICS];          // message of each; NULL before the first
  uint64_t client;                    // of the requests
  uint64_t last_id;
  dds_time_t deadline;  // when everything must be done
} vehicle_t;

// Joins the domain. Everything must be done within so many seconds.
void join(vehicle_t* vehicle, int domain, const char* name, int seconds, reader_qos_t qos);
void leave(vehicle_t* vehicle);

// Waits for samples, 20 ms at most, and takes all that there are. Fails after the deadline with what was waited for.
void pump(vehicle_t* vehicle, const char* waiting_for);

const void* newest(const vehicle_t* vehicle, const char* topic);  // NULL before the first sample
uint64_t count(const vehicle_t* vehicle, const char* topic);

#endif
