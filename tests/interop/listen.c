// Decodes the topics of a vehicle, as a node of ROS 2 subscribes to sensor data, until each of the given ones was heard.
// usage: listen DOMAIN VEHICLE SECONDS TOPIC...
#include <stdio.h>
#include <stdlib.h>

#include "vehicle.h"

int main(int argc, char** argv) {
  if (argc < 5) fail("usage: listen DOMAIN VEHICLE SECONDS TOPIC...");
  vehicle_t vehicle;
  join(&vehicle, atoi(argv[1]), argv[2], atoi(argv[3]), SENSOR_DATA);
  for (int i = 4; i < argc; ++i) {
    while (count(&vehicle, argv[i]) == 0) pump(&vehicle, argv[i]);
    printf("%s\n", argv[i]);
  }
  leave(&vehicle);
  return 0;
}
