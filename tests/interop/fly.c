// Flies a simulated vehicle that runs in lockstep and waits for simulation_clock: arms, takes off, goes to a point, streams
// setpoints, flies a trajectory and a mission, and lands. Prints how many samples of each topic it decoded.
// usage: fly DOMAIN VEHICLE SECONDS
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "vehicle.h"

#define MSG(name) swiftlet_msgs_msg_dds__##name##_
#define CONSTANT(type, name) swiftlet_msgs_msg_##type##_Constants_##name

static const int64_t STEP_NS = 200000000;     // of simulated time
static const dds_duration_t CLOCK_PERIOD = DDS_MSECS(200);
static const int64_t LINK_NS = 50000000;      // between heartbeats
static const int64_t SETPOINT_NS = 20000000;  // between setpoints
static const double NEAR_M = 0.05;            // of a goal
static const double HEIGHT_M = 0.8;

typedef struct {
  vehicle_t vehicle;
  dds_entity_t clock, command, mission, trajectory, setpoint, ground_link;
  MSG(SimulationClock) advance;
  dds_time_t clock_sent;
  MSG(GroundLink) link;
} pilot_t;

static void send(dds_entity_t writer, const void* message, const char* what) {
  const dds_return_t result = dds_write(writer, message);
  if (result != DDS_RETCODE_OK) fail("%s was not sent: %s", what, dds_strretcode(result));
}

static const MSG(ControlStatus) * status_of(const pilot_t* pilot) { return newest(&pilot->vehicle, "control_status"); }

static int64_t now_ns(const pilot_t* pilot) {
  const MSG(Imu)* imu = newest(&pilot->vehicle, "imu");
  return imu == NULL ? 0 : imu->stamp_ns;
}

// Lets simulated time go on, takes what comes, and sends a heartbeat when one is due. The vehicle hears the clock five times a
// second even while time stands still.
static void step(pilot_t* pilot, const char* waiting_for) {
  pump(&pilot->vehicle, waiting_for);
  const bool advances = now_ns(pilot) + STEP_NS / 2 >= pilot->advance.advance_to_ns;
  if (advances || dds_time() - pilot->clock_sent >= CLOCK_PERIOD) {
    if (advances) pilot->advance.advance_to_ns += STEP_NS;
    ++pilot->advance.sequence_number;
    pilot->clock_sent = dds_time();
    send(pilot->clock, &pilot->advance, "simulation_clock");
  }
  if (pilot->link.client != 0 && now_ns(pilot) - pilot->link.stamp_ns >= LINK_NS) {
    ++pilot->link.sequence_number;
    pilot->link.stamp_ns = now_ns(pilot);
    send(pilot->ground_link, &pilot->link, "ground_link");
  }
}

static void wait_for_answer(pilot_t* pilot, uint64_t id, const char* what) {
  const MSG(CommandAck)* ack;
  do {
    step(pilot, what);
    ack = newest(&pilot->vehicle, "command_ack");
  } while (ack == NULL || ack->client != pilot->vehicle.client || ack->id != id);
  if (!ack->accepted) fail("%s: refused: %s", what, ack->reason);
}

static void wait_for_success(pilot_t* pilot, uint64_t id, const char* what) {
  while (true) {
    step(pilot, what);
    const MSG(RequestStatus)* request = &status_of(pilot)->request;
    if (request->client != pilot->vehicle.client || request->id != id) continue;
    if (request->state == CONSTANT(RequestStatus, SUCCEEDED)) return;
    if (request->state > CONSTANT(RequestStatus, SUCCEEDED)) fail("%s: %s", what, request->result);
  }
}

static MSG(Command) command_of(pilot_t* pilot, uint8_t kind) {
  MSG(Command) command;
  memset(&command, 0, sizeof command);
  command.client = pilot->vehicle.client;
  command.id = ++pilot->vehicle.last_id;
  command.kind = kind;
  command.yaw_free = true;
  command.speed = 1.0;
  return command;
}

static void execute(pilot_t* pilot, const MSG(Command) * command, const char* what) {
  send(pilot->command, command, what);
  wait_for_answer(pilot, command->id, what);
  wait_for_success(pilot, command->id, what);
  printf("%s: done at %.1f s\n", what, 1e-9 * (double)now_ns(pilot));
}

// The vehicle is where it should be, by the truth of the simulation and by the estimate.
static void require_at(const pilot_t* pilot, const double goal[3], const char* what) {
  const MSG(GroundTruth)* truth = newest(&pilot->vehicle, "ground_truth");
  const MSG(Estimate)* estimate = newest(&pilot->vehicle, "estimate");
  for (int i = 0; i < 3; ++i) {
    if (!(fabs(truth->position_ned[i] - goal[i]) < NEAR_M) || !(fabs(estimate->position_ned[i] - goal[i]) < NEAR_M))
      fail("%s: coordinate %d is %g, estimated %g, must be %g", what, i, truth->position_ned[i], estimate->position_ned[i], goal[i]);
  }
}

// Setpoints at the given place for two simulated seconds.
static void stream(pilot_t* pilot, const double goal[3]) {
  MSG(Setpoint) setpoint;
  memset(&setpoint, 0, sizeof setpoint);
  setpoint.kind = CONSTANT(Setpoint, POSITION);
  memcpy(setpoint.position_ned, goal, sizeof setpoint.position_ned);
  setpoint.q_ned_from_frd[0] = 1.0;
  setpoint.yaw_free = true;
  const uint64_t before = status_of(pilot)->setpoints_accepted;
  const int64_t end_ns = now_ns(pilot) + 2000000000;
  while (now_ns(pilot) < end_ns || status_of(pilot)->setpoints_accepted < before + 5) {
    step(pilot, "accepted setpoints");
    if (now_ns(pilot) - setpoint.stamp_ns < SETPOINT_NS) continue;
    ++setpoint.sequence_number;
    setpoint.stamp_ns = now_ns(pilot);
    send(pilot->setpoint, &setpoint, "setpoint");
  }
  if (status_of(pilot)->setpoints_refused > 0) fail("setpoint refused: %s", status_of(pilot)->setpoint_refusal);
  printf("setpoints: %llu accepted\n", (unsigned long long)(status_of(pilot)->setpoints_accepted - before));
}

// A straight way from rest to rest in 3 s, s(t) = 10 u^3 - 15 u^4 + 6 u^5 with u = t/3 s.
static void fly_trajectory(pilot_t* pilot, const double from[3], const double to[3]) {
  const double duration_s = 3.0;
  const double shape[6] = {0, 0, 0, 10 / pow(duration_s, 3), -15 / pow(duration_s, 4), 6 / pow(duration_s, 5)};
  MSG(PolynomialSegment) segment;
  memset(&segment, 0, sizeof segment);
  segment.duration_s = duration_s;
  double* const axes[3] = {segment.x, segment.y, segment.z};
  for (int axis = 0; axis < 3; ++axis) {
    for (int power = 0; power < 6; ++power) axes[axis][power] = shape[power] * (to[axis] - from[axis]);
    axes[axis][0] = from[axis];
  }
  MSG(Trajectory) trajectory;
  memset(&trajectory, 0, sizeof trajectory);
  trajectory.client = pilot->vehicle.client;
  trajectory.id = ++pilot->vehicle.last_id;
  trajectory.segments._buffer = &segment;
  trajectory.segments._length = trajectory.segments._maximum = 1;
  send(pilot->trajectory, &trajectory, "trajectory");
  wait_for_answer(pilot, trajectory.id, "trajectory");
  wait_for_success(pilot, trajectory.id, "trajectory");
  printf("trajectory: done at %.1f s\n", 1e-9 * (double)now_ns(pilot));
  require_at(pilot, to, "end of the trajectory");
}

// Uploads two waypoints, starts the mission and follows it to its end.
static void fly_mission(pilot_t* pilot, const double corners[2][3]) {
  MSG(MissionItem) items[2];
  memset(items, 0, sizeof items);
  for (int i = 0; i < 2; ++i) {
    items[i].kind = CONSTANT(MissionItem, WAYPOINT);
    memcpy(items[i].position_ned, corners[i], sizeof items[i].position_ned);
    items[i].yaw_free = true;
    items[i].speed = 1.0;
    items[i].hold_s = 0.2;
  }
  MSG(Mission) mission;
  memset(&mission, 0, sizeof mission);
  mission.client = pilot->vehicle.client;
  mission.id = ++pilot->vehicle.last_id;
  mission.items._buffer = items;
  mission.items._length = mission.items._maximum = 2;
  send(pilot->mission, &mission, "mission");
  wait_for_answer(pilot, mission.id, "mission upload");

  MSG(Command) start = command_of(pilot, CONSTANT(Command, MISSION_START));
  start.mission_id = mission.id;
  execute(pilot, &start, "mission");
  const MSG(MissionStatus)* status = newest(&pilot->vehicle, "mission_status");
  while (status->mission_id != mission.id || status->state != CONSTANT(MissionStatus, COMPLETED)) {
    step(pilot, "completed mission");
    status = newest(&pilot->vehicle, "mission_status");
  }
  require_at(pilot, corners[1], "end of the mission");
  const MSG(Mission)* flown = newest(&pilot->vehicle, "flown_mission");
  if (flown->id != mission.id || flown->items._length != 2 || flown->items._buffer[1].position_ned[0] != corners[1][0])
    fail("flown_mission is not the uploaded one");
}

static dds_entity_t writer(pilot_t* pilot, const char* vehicle, const char* topic) {
  return create_writer(pilot->vehicle.participant, vehicle, find_topic(topic));
}

int main(int argc, char** argv) {
  if (argc != 4) fail("usage: fly DOMAIN VEHICLE SECONDS");
  const char* name = argv[2];
  pilot_t pilot;
  memset(&pilot, 0, sizeof pilot);
  join(&pilot.vehicle, atoi(argv[1]), name, atoi(argv[3]), OF_TOPIC);
  pilot.clock = writer(&pilot, name, "simulation_clock");
  pilot.command = writer(&pilot, name, "command");
  pilot.mission = writer(&pilot, name, "mission");
  pilot.trajectory = writer(&pilot, name, "trajectory");
  pilot.setpoint = writer(&pilot, name, "setpoint");
  pilot.ground_link = writer(&pilot, name, "ground_link");

  while (status_of(&pilot) == NULL || !status_of(&pilot)->has_pose) step(&pilot, "a pose");
  pilot.link.client = pilot.vehicle.client;
  pilot.link.depends = true;  // the link-loss failsafe acts if the heartbeats are not understood
  while (status_of(&pilot)->ground_links != 1) step(&pilot, "a ground link");

  MSG(Command) command = command_of(&pilot, CONSTANT(Command, ARM));
  execute(&pilot, &command, "arm");
  command = command_of(&pilot, CONSTANT(Command, TAKEOFF));
  command.position_ned[2] = -HEIGHT_M;
  execute(&pilot, &command, "takeoff");
  const double goal[3] = {0.5, -0.4, -HEIGHT_M};
  command = command_of(&pilot, CONSTANT(Command, GOTO));
  memcpy(command.position_ned, goal, sizeof goal);
  execute(&pilot, &command, "goto");
  require_at(&pilot, goal, "goal");
  stream(&pilot, goal);
  command = command_of(&pilot, CONSTANT(Command, HOLD));
  execute(&pilot, &command, "hold");
  const double end[3] = {-0.3, 0.2, -1.0};
  fly_trajectory(&pilot, goal, end);
  const double corners[2][3] = {{0.4, 0.4, -0.6}, {0.0, 0.0, -HEIGHT_M}};
  fly_mission(&pilot, corners);
  command = command_of(&pilot, CONSTANT(Command, LAND));
  execute(&pilot, &command, "land");
  while (status_of(&pilot)->mode != CONSTANT(ControlStatus, MODE_DISARMED)) step(&pilot, "disarmed");

  for (size_t i = 0; i < topic_count; ++i) {
    if (pilot.vehicle.counts[i] > 0) printf("decoded %s %llu\n", topics[i].name, (unsigned long long)pilot.vehicle.counts[i]);
  }
  leave(&pilot.vehicle);
  return 0;
}
