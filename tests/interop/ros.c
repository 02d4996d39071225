// A program of ROS 2 as it is on the wire, without ROS 2: reads the standard types that swiftlet-ros publishes, finds the processes
// of the vehicle as nodes, sends the vehicle to a goal and moves it by velocities. The vehicle has taken off.
// usage: ros DOMAIN VEHICLE SECONDS
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ros_types.h"
#include "topics.h"

#define TYPE(package, name) &package##_msg_dds__##name##__desc

typedef geometry_msgs_msg_dds__PoseStamped_ pose_t;
typedef rmw_dds_common_msg_dds__ParticipantEntitiesInfo_ entities_t;

// What rclpy and rclcpp ask for: reliable, volatile, the last ten.
enum { POSE, REFERENCE, PATH, ODOMETRY, IMU, BATTERY, TF, CLOCK, INPUTS };
static const struct {
  const char* name;  // %s: the vehicle
  const dds_topic_descriptor_t* type;
} inputs[INPUTS] = {
    [POSE] = {"rt/%s/pose", TYPE(geometry_msgs, PoseStamped)},
    [REFERENCE] = {"rt/%s/reference_pose", TYPE(geometry_msgs, PoseStamped)},
    [PATH] = {"rt/%s/path", TYPE(nav_msgs, Path)},
    [ODOMETRY] = {"rt/%s/odometry", TYPE(nav_msgs, Odometry)},
    [IMU] = {"rt/%s/imu_flu", TYPE(sensor_msgs, Imu)},
    [BATTERY] = {"rt/%s/battery_state", TYPE(sensor_msgs, BatteryState)},
    [TF] = {"rt/tf", TYPE(tf2_msgs, TFMessage)},
    [CLOCK] = {"rt/clock", TYPE(rosgraph_msgs, Clock)},
};

static const double NEAR_M = 0.05;
static const double GOAL_ENU[3] = {0.6, -0.4, 0.9};

typedef struct {
  dds_entity_t participant, waitset, readers[INPUTS], graph, goal, velocity, publications, subscriptions;
  topic_t topics[INPUTS], graph_topic;
  void* newest[INPUTS];
  uint64_t counts[INPUTS];
  dds_time_t deadline;
} peer_t;

static dds_entity_t topic_in(dds_entity_t participant, const char* format, const char* vehicle, const dds_topic_descriptor_t* type) {
  char name[256];
  snprintf(name, sizeof name, format, vehicle);
  const dds_entity_t topic = dds_create_topic(participant, type, name, NULL, NULL);
  if (topic < 0) fail("%s: no topic: %s", name, dds_strretcode(topic));
  return topic;
}

static dds_qos_t* ros_qos(bool latched) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  if (latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, latched ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST, 10);
  return qos;
}

static void join_ros(peer_t* peer, int domain, const char* vehicle, int seconds) {
  memset(peer, 0, sizeof *peer);
  peer->deadline = dds_time() + DDS_SECS(seconds);
  peer->participant = dds_create_participant((dds_domainid_t)domain, NULL, NULL);
  if (peer->participant < 0) fail("no participant: %s", dds_strretcode(peer->participant));
  peer->waitset = dds_create_waitset(peer->participant);
  dds_qos_t* qos = ros_qos(false);
  for (int i = 0; i < INPUTS; ++i) {
    peer->topics[i] = (topic_t){inputs[i].name, inputs[i].type, Stream};
    peer->readers[i] = dds_create_reader(peer->participant, topic_in(peer->participant, inputs[i].name, vehicle, inputs[i].type), qos, NULL);
    dds_set_status_mask(peer->readers[i], DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(peer->waitset, peer->readers[i], i);
  }
  peer->goal = dds_create_writer(
      peer->participant, topic_in(peer->participant, "rt/%s/goal_pose", vehicle, TYPE(geometry_msgs, PoseStamped)), qos, NULL);
  peer->velocity = dds_create_writer(
      peer->participant, topic_in(peer->participant, "rt/%s/cmd_vel", vehicle, TYPE(geometry_msgs, Twist)), qos, NULL);
  dds_delete_qos(qos);
  qos = ros_qos(true);
  peer->graph_topic = (topic_t){"ros_discovery_info", TYPE(rmw_dds_common, ParticipantEntitiesInfo), Latched};
  peer->graph = dds_create_reader(
      peer->participant, topic_in(peer->participant, "%s", "ros_discovery_info", peer->graph_topic.type), qos, NULL);
  dds_delete_qos(qos);
  peer->publications = dds_create_reader(peer->participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, NULL, NULL);
  peer->subscriptions = dds_create_reader(peer->participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, NULL, NULL);
}

static void pump_ros(peer_t* peer, const char* waiting_for) {
  if (dds_time() > peer->deadline) fail("waited in vain for %s", waiting_for);
  dds_waitset_wait(peer->waitset, NULL, 0, DDS_MSECS(20));
  for (int i = 0; i < INPUTS; ++i) {
    void* message;
    while ((message = take(peer->readers[i], &peer->topics[i])) != NULL) {
      if (peer->newest[i] != NULL) dds_sample_free(peer->newest[i], inputs[i].type, DDS_FREE_ALL);
      peer->newest[i] = message;
      ++peer->counts[i];
    }
  }
}

static double stamp_s(builtin_interfaces_msg_dds__Time_ stamp) { return stamp.sec + 1e-9 * stamp.nanosec; }

// Topic that a writer with this number publishes; "" if it is not known.
static void topic_of_writer(peer_t* peer, const rmw_dds_common_msg_dds__Gid_* gid, char* name, size_t size) {
  enum { MOST = 512 };
  static void* samples[MOST];
  static dds_sample_info_t infos[MOST];
  memset(samples, 0, sizeof samples);
  const int count = dds_read(peer->publications, samples, infos, MOST, MOST);
  name[0] = 0;
  for (int i = 0; i < count; ++i) {
    const dds_builtintopic_endpoint_t* writer = samples[i];
    if (infos[i].valid_data && memcmp(writer->key.v, gid->data, sizeof gid->data) == 0) snprintf(name, size, "%s", writer->topic_name);
  }
  dds_return_loan(peer->publications, samples, count);
}

// Prints topic, type and user data of the endpoints of others.
static void print_endpoints(const peer_t* peer, dds_entity_t endpoints, const char* kind) {
  enum { MOST = 512 };
  static void* samples[MOST];
  static dds_sample_info_t infos[MOST];
  memset(samples, 0, sizeof samples);
  dds_guid_t own;
  dds_get_guid(peer->participant, &own);
  const int count = dds_read(endpoints, samples, infos, MOST, MOST);
  for (int i = 0; i < count; ++i) {
    const dds_builtintopic_endpoint_t* endpoint = samples[i];
    if (!infos[i].valid_data || memcmp(&endpoint->participant_key, &own, sizeof own) == 0) continue;
    void* data = NULL;
    size_t size = 0;
    const bool has_data = dds_qget_userdata(endpoint->qos, &data, &size);
    printf("%s %s %s %.*s\n", kind, endpoint->topic_name, endpoint->type_name, has_data ? (int)size : 0, has_data ? (const char*)data : "");
    dds_free(data);
  }
  dds_return_loan(endpoints, samples, count);
}

// Waits for the node /vehicle/name, with a writer of its topic.
static void find_node(peer_t* peer, const char* vehicle, const char* name, const char* topic) {
  char space[128], wanted[256], found[256];
  snprintf(space, sizeof space, "/%s", vehicle);
  snprintf(wanted, sizeof wanted, "rt/%s/%s", vehicle, topic);
  while (true) {
    pump_ros(peer, wanted);
    void* samples[64] = {NULL};
    dds_sample_info_t infos[64];
    const int count = dds_read(peer->graph, samples, infos, 64, 64);
    bool is_found = false;
    for (int i = 0; i < count; ++i) {
      const entities_t* entities = samples[i];
      for (uint32_t n = 0; infos[i].valid_data && n < entities->node_entities_info_seq._length; ++n) {
        const rmw_dds_common_msg_dds__NodeEntitiesInfo_* node = &entities->node_entities_info_seq._buffer[n];
        if (strcmp(node->node_name, name) != 0 || strcmp(node->node_namespace, space) != 0) continue;
        for (uint32_t w = 0; w < node->writer_gid_seq._length; ++w) {
          topic_of_writer(peer, &node->writer_gid_seq._buffer[w], found, sizeof found);
          is_found = is_found || strcmp(found, wanted) == 0;
        }
      }
    }
    dds_return_loan(peer->graph, samples, count);
    if (is_found) break;
  }
  printf("node %s/%s publishes %s\n", space, name, topic);
}

static double distance_to(const pose_t* pose, const double goal[3]) {
  const double dx = pose->pose.position.x - goal[0], dy = pose->pose.position.y - goal[1], dz = pose->pose.position.z - goal[2];
  return sqrt(dx * dx + dy * dy + dz * dz);
}

static void check_messages(const peer_t* peer, const char* vehicle) {
  const pose_t* pose = peer->newest[POSE];
  const nav_msgs_msg_dds__Odometry_* odometry = peer->newest[ODOMETRY];
  const nav_msgs_msg_dds__Path_* path = peer->newest[PATH];
  const sensor_msgs_msg_dds__Imu_* imu = peer->newest[IMU];
  const sensor_msgs_msg_dds__BatteryState_* battery = peer->newest[BATTERY];
  const tf2_msgs_msg_dds__TFMessage_* tf = peer->newest[TF];
  const rosgraph_msgs_msg_dds__Clock_* clock = peer->newest[CLOCK];
  if (strcmp(pose->header.frame_id, "map") != 0 || strcmp(odometry->child_frame_id, vehicle) != 0) fail("wrong frames");
  if (fabs(stamp_s(clock->clock) - stamp_s(pose->header.stamp)) > 0.5) fail("clock and pose differ in time");
  if (path->poses._length < 2) fail("the path has %u poses", path->poses._length);
  if (!(fabs(imu->linear_acceleration.z - 9.8) < 3.0)) fail("the IMU measures %g m/s^2 upwards", imu->linear_acceleration.z);
  if (!(battery->voltage > 3.0) || !(battery->percentage > 0.5)) fail("the battery has %g V", battery->voltage);
  if (tf->transforms._length != 1 || strcmp(tf->transforms._buffer[0].child_frame_id, vehicle) != 0) fail("no transform of the vehicle");
  if (!(odometry->pose.covariance[0] > 0.0) || !(odometry->pose.covariance[35] > 0.0)) fail("the odometry has no covariance");
}

int main(int argc, char** argv) {
  if (argc != 4) fail("usage: ros DOMAIN VEHICLE SECONDS");
  const char* vehicle = argv[2];
  peer_t peer;
  join_ros(&peer, atoi(argv[1]), vehicle, atoi(argv[3]));
  for (int i = 0; i < INPUTS; ++i) {
    while (peer.counts[i] < 2) pump_ros(&peer, inputs[i].name);
  }
  check_messages(&peer, vehicle);
  find_node(&peer, vehicle, "plant", "imu");
  find_node(&peer, vehicle, "control", "estimate");
  find_node(&peer, vehicle, "ros", "pose");

  pose_t goal;
  memset(&goal, 0, sizeof goal);
  goal.header.frame_id = "map";
  goal.pose.position.x = GOAL_ENU[0];
  goal.pose.position.y = GOAL_ENU[1];
  goal.pose.position.z = GOAL_ENU[2];
  goal.pose.orientation.w = 1.0;  // faces east
  if (dds_write(peer.goal, &goal) != DDS_RETCODE_OK) fail("the goal was not sent");
  do pump_ros(&peer, "arrival at the goal");
  while (distance_to(peer.newest[POSE], GOAL_ENU) > NEAR_M);
  const nav_msgs_msg_dds__Odometry_* odometry;
  do {
    pump_ros(&peer, "rest at the goal, facing east");
    odometry = peer.newest[ODOMETRY];
  } while (fabs(odometry->twist.twist.linear.x) > 0.01 || fabs(odometry->pose.pose.orientation.z) > 0.02);
  printf("goal: reached\n");

  geometry_msgs_msg_dds__Twist_ velocity;
  memset(&velocity, 0, sizeof velocity);
  velocity.linear.x = 0.4;  // forward: to the east
  const double* end = (const double[3]){GOAL_ENU[0] + 0.5, GOAL_ENU[1], GOAL_ENU[2]};
  const pose_t* pose;
  do {
    if (dds_write(peer.velocity, &velocity) != DDS_RETCODE_OK) fail("a velocity was not sent");
    pump_ros(&peer, "half a metre to the east");
    pose = peer.newest[POSE];
  } while (pose->pose.position.x < end[0]);
  if (fabs(pose->pose.position.y - end[1]) > 2 * NEAR_M || fabs(pose->pose.position.z - end[2]) > 2 * NEAR_M)
    fail("the vehicle drifted to %g %g %g", pose->pose.position.x, pose->pose.position.y, pose->pose.position.z);
  printf("velocities: obeyed\n");
  print_endpoints(&peer, peer.publications, "writer");
  print_endpoints(&peer, peer.subscriptions, "reader");
  for (int i = 0; i < INPUTS; ++i) dds_sample_free(peer.newest[i], inputs[i].type, DDS_FREE_ALL);
  dds_delete(peer.participant);
  return 0;
}
