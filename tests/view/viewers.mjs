// Viewers that get what the live page gets. usage: node viewers.mjs URL COUNT SECONDS. Prints a JSON object: messages of each
// viewer a second, and of the estimate of each vehicle.
import {connect} from './viewer.mjs';

const [url, count, seconds] = process.argv.slice(2);
const shown = ['estimate', 'reference', 'control_status', 'mission_status', 'battery', 'vehicle_info', 'log'];
let messages = 0;
let estimates = 0;
const vehicles = new Set();
const viewers = Array.from({length: Number(count)}, () => {
  const client = connect(url, 'newest');
  const topics = new Map();
  client.on('error', (error) => { throw error; });
  client.on('status', ({message}) => console.error(message));
  client.on('advertise', (channels) => {
    for (const {id, topic} of channels.filter(({topic: name}) => shown.includes(name.split('/')[2]))) {
      topics.set(client.subscribe(id), topic);
      vehicles.add(topic.split('/')[1]);
    }
  });
  client.on('message', ({subscriptionId}) => {
    ++messages;
    if (topics.get(subscriptionId).endsWith('/estimate')) ++estimates;
  });
  return client;
});
setTimeout(() => {
  const each = viewers.length * Number(seconds);
  console.log(JSON.stringify({messages_hz: messages / each, estimates_hz: estimates / each / vehicles.size, vehicles: vehicles.size}));
  process.exit();
}, 1000 * Number(seconds));
