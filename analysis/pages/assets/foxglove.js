// A client of the Foxglove WebSocket protocol. It connects again when the connection is lost, and subscribes again.
'use strict';

swiftlet.Foxglove = class {
  // on: {state(text, isOpen), channel(channel), status({level, message})}
  constructor(url, on) {
    this.url = url;
    this.on = on;
    this.listeners = new Map();  // by topic: callbacks
    this.types = new Map();      // of the messages that have come, by topic
    this.calls = new Map();      // by call id: {resolve, reject}
    this.lastCall = 0;
    this.connect();
  }

  connect() {
    this.channels = new Map();  // by id, and by topic
    this.services = new Map();  // by name
    this.socket = new WebSocket(this.url, ['foxglove.sdk.v1', 'foxglove.websocket.v1']);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => this.on.state('connected', true);
    this.socket.onmessage = ({data}) => (typeof data === 'string' ? this.take(JSON.parse(data)) : this.takeBinary(new DataView(data)));
    this.socket.onclose = () => {
      this.on.state('no connection to swiftlet; trying again', false);
      for (const {reject} of this.calls.values()) reject(new Error('the connection was lost before the answer'));
      this.calls.clear();
      setTimeout(() => this.connect(), 1000);
    };
  }

  take(message) {
    if (message.op === 'advertise') message.channels.forEach((channel) => this.addChannel(channel));
    if (message.op === 'advertiseServices') message.services.forEach((service) => this.services.set(service.name, service));
    if (message.op === 'status') this.on.status(message);
    if (message.op === 'serviceCallFailure') this.settle(message.callId, ({reject}) => reject(new Error(message.message)));
  }

  addChannel(channel) {
    this.channels.set(channel.id, channel);
    this.channels.set(channel.topic, channel);
    if (this.listeners.has(channel.topic)) this.subscribe(channel);
    this.on.channel(channel);
  }

  takeBinary(view) {
    if (view.getUint8(0) === 1) {
      const channel = this.channels.get(view.getUint32(1, true));
      const time = Number(view.getBigUint64(5, true)) / 1e9;
      const message = swiftlet.cdr.read(this.typeOf(channel), new DataView(view.buffer, 13));
      this.listeners.get(channel.topic).forEach((listener) => listener(message, time));
    } else if (view.getUint8(0) === 3) {
      const start = 13 + view.getUint32(9, true);
      this.settle(view.getUint32(5, true), ({resolve, type}) => resolve(swiftlet.cdr.read(type, new DataView(view.buffer, start))));
    }
  }

  settle(id, how) {
    const call = this.calls.get(id);
    this.calls.delete(id);
    if (call) how(call);
  }

  typeOf(channel) {
    if (!channel.type) this.types.set(channel.topic, channel.type = swiftlet.cdr.parse(channel.schema));
    return channel.type;
  }

  subscribe(channel) {
    this.socket.send(JSON.stringify({op: 'subscribe', subscriptions: [{id: channel.id, channelId: channel.id}]}));
  }

  // Calls listener(message, time in s) for each message of a topic, as soon as there is such a topic.
  listen(topic, listener) {
    const known = this.listeners.get(topic);
    if (known) return known.push(listener);
    this.listeners.set(topic, [listener]);
    if (this.channels.has(topic)) this.subscribe(this.channels.get(topic));
  }

  // Calls a service with a request in CDR. Resolves to the response.
  call(name, request) {
    const service = this.services.get(name);
    if (!service || this.socket.readyState !== WebSocket.OPEN) return Promise.reject(new Error('there is no connection'));
    const id = ++this.lastCall;
    const encoding = new TextEncoder().encode('cdr');
    const bytes = new Uint8Array(13 + encoding.length + request.length);
    const view = new DataView(bytes.buffer);
    view.setUint8(0, 2);
    view.setUint32(1, service.id, true);
    view.setUint32(5, id, true);
    view.setUint32(9, encoding.length, true);
    bytes.set(encoding, 13);
    bytes.set(request, 13 + encoding.length);
    this.socket.send(bytes);
    return new Promise((resolve, reject) =>
      this.calls.set(id, {resolve, reject, type: swiftlet.cdr.parse(service.response.schema)}));
  }
};
