// Decodes each topic of a server as Foxglove does, and compares it with what the page reads (cdr.js).
//
// usage: node decode.mjs URL. Prints a JSON object.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import vm from 'node:vm';
import {parse} from '@foxglove/rosmsg';
import {MessageReader} from '@foxglove/rosmsg2-serialization';
import {connect} from './viewer.mjs';

// Topics on which something comes in every flight.
const expected = ['imu', 'actuator_command', 'controller_state', 'mocap_pose', 'rotor_speeds', 'battery', 'estimate', 'reference', 'ground_truth',
  'control_status', 'mission_status', 'vehicle_info', 'pose', 'odometry', 'path', 'reference_pose', 'imu_flu', 'battery_state', 'log']
  .flatMap((name) => [`/kl1/${name}`, `/kl2/${name}`]).concat('/tf');

const page = {swiftlet: {}, DataView, Uint8Array, TextDecoder};
vm.runInNewContext(readFileSync('cdr.js', 'utf8'), page);
const {cdr} = page.swiftlet;
const plain = (value) => JSON.parse(JSON.stringify(value, (_, item) =>
  (typeof item === 'bigint' ? Number(item) : ArrayBuffer.isView(item) ? Array.from(item, Number) : item)));

const channels = new Map();
const topics = {};
let messages = 0;

await new Promise((resolve, reject) => {
  const client = connect(process.argv[2]);
  const late = setTimeout(() => reject(new Error(`nothing came of ${expected.filter((topic) => !topics[topic])}`)), 20000);
  client.on('error', reject);
  client.on('advertise', (list) => {
    for (const channel of list) {
      assert.equal(channel.encoding, 'cdr');
      assert.equal(channel.schemaEncoding, 'ros2msg');
      channels.set(client.subscribe(channel.id), {
        topic: channel.topic, theirs: new MessageReader(parse(channel.schema, {ros2: true})), ours: cdr.parse(channel.schema),
      });
    }
  });
  let stop;
  client.on('advertiseServices', (services) => {
    stop ??= services.find(({name}) => name === '/kl1/stop');
    if (!stop) return;
    client.sendServiceCallRequest({serviceId: stop.id, callId: 7, encoding: 'cdr', data: new Uint8Array([0, 1, 0, 0, 0])});
  });
  let refused = false;
  client.on('serviceCallFailure', ({callId, message}) => {
    refused = callId === 7 && message === 'stop is not confirmed: data must be true';
  });
  client.on('message', ({subscriptionId, data}) => {
    const {topic, theirs, ours} = channels.get(subscriptionId);
    try {
      const bytes = new DataView(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength));
      assert.deepEqual(plain(cdr.read(ours, bytes)), plain(theirs.readMessage(bytes)));
    } catch (error) {
      reject(new Error(`${topic}: ${error.message}`));
    }
    topics[topic] = (topics[topic] ?? 0) + 1;
    ++messages;
    if (!refused || !expected.every((name) => topics[name])) return;
    clearTimeout(late);
    client.close();
    resolve();
  });
});
console.log(JSON.stringify({messages, topics}));
