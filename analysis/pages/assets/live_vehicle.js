// One vehicle of the live page: what it says, its state as a card, and the requests to it.
'use strict';

swiftlet.LiveVehicle = class {
  // client: a Foxglove. on: {event(vehicle, time in s since 1970, text, warning), time(time)}
  constructor(name, index, client, on) {
    this.name = name;
    this.colour = index;
    this.client = client;
    this.on = on;
    this.newest = {};   // messages by topic
    this.arrived = {};  // when they arrived, s of the server
    this.signals = {};  // tracks by topic and signal
    this.track = new swiftlet.Track(['north', 'east', 'down', 'w', 'x', 'y', 'z']);
    this.referenceTrack = new swiftlet.Track(['north', 'east', 'down']);
    this.listen('estimate', (message, time) => this.track.push(time, [...message.position_ned, ...message.q_ned_from_frd]));
    this.listen('reference', (message, time) => this.referenceTrack.push(time, message.position_ned));
    for (const topic of ['control_status', 'mission_status', 'battery', 'vehicle_info']) this.listen(topic, () => {});
    client.listen(`/${name}/log`, ({message, level}, serverTime) => on.event(this, serverTime, message, level > 2));
    this.makeCard();
  }

  listen(topic, take) {
    this.client.listen(`/${this.name}/${topic}`, (message, serverTime) => {
      const time = this.on.time(serverTime);
      this.newest[topic] = message;
      this.arrived[topic] = serverTime;
      take(message, time);
    });
  }

  // As Scene has it.
  get path() {
    const q = ['w', 'x', 'y', 'z'].map((name) => this.track.column(name));
    return {...this.placesOf(this.track), q};
  }
  get reference() {
    return this.placesOf(this.referenceTrack);
  }
  placesOf(track) {
    const [north, east, down] = ['north', 'east', 'down'].map((name) => track.column(name));
    return {t: track.times(), north, east, down};
  }

  // A signal over time, from now on: a function that gives its {t, y}.
  signal(topic, name, scale) {
    const key = `${topic}.${name}`;
    let track = this.signals[key];
    if (!track) {
      track = this.signals[key] = new swiftlet.Track(['y']);
      const value = swiftlet.cdr.signal(name);
      this.listen(topic, (message, time) => track.push(time, [scale * value(message)]));
    }
    return () => ({t: track.times(), y: track.column('y')});
  }

  makeCard() {
    const add = (parent, element) => (parent.append(element), element);
    this.card = swiftlet.element('article', {class: 'vehicle', 'data-vehicle': this.name});
    this.card.style.setProperty('--key', `var(--series-${this.colour % 8})`);
    const head = add(this.card, swiftlet.element('h3', {}, this.name));
    this.mode = add(head, swiftlet.element('span', {class: 'badge'}, 'not heard'));
    this.reason = add(this.card, swiftlet.element('p', {class: 'quiet'}));
    const list = add(this.card, swiftlet.element('dl'));
    this.values = Object.fromEntries(
      ['N, E, up', 'speed', 'battery', 'mission', 'pose', 'loop', 'command'].map((label) => {
        add(list, swiftlet.element('dt', {}, label));
        return [label, add(list, swiftlet.element('dd', {}, '–'))];
      }));
    const buttons = add(this.card, swiftlet.element('div', {class: 'buttons'}));
    for (const kind of ['hold', 'land', 'stop']) {
      const button = add(buttons, swiftlet.element('button', {
        type: 'button', class: kind === 'stop' ? 'danger' : '', 'data-request': kind, 'aria-label': `${kind} ${this.name}`,
      }, kind[0].toUpperCase() + kind.slice(1)));
      button.addEventListener('click', () => swiftlet.requestOf([this], kind));
    }
    this.answer = add(this.card, swiftlet.element('p', {class: 'answer', role: 'status'}));
  }

  async request(kind) {
    this.answer.textContent = `${kind}: sent`;
    try {
      const {success, message} = await this.client.call(`/${this.name}/${kind}`, new Uint8Array([0, 1, 0, 0, 1]));
      this.answer.textContent = `${kind}: ${success ? 'accepted' : 'refused'}${message ? `: ${message}` : ''}`;
      this.answer.classList.toggle('refused', !success);
      return success;
    } catch (error) {
      this.answer.textContent = `${kind}: ${error.message}`;
      this.answer.classList.add('refused');
      return false;
    }
  }

  // now: s of the server.
  show(now) {
    const {estimate, control_status: status, battery, mission_status: mission, vehicle_info: info} = this.newest;
    const set = (label, text) => {
      if (this.values[label].textContent !== text) this.values[label].textContent = text;
    };
    const number = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits).replace('-', '−') : '–');
    if (status) this.showStatus(status, now - this.arrived.control_status);
    if (estimate) {
      const [north, east, down] = estimate.position_ned;
      set('N, E, up', `${number(north, 2)}, ${number(east, 2)}, ${number(-down, 2)} m`);
      set('speed', `${number(Math.hypot(...estimate.velocity_ned), 2)} m/s`);
    }
    if (battery) set('battery', `${number(battery.voltage_v, 2)} V, ${number(100 * battery.state_of_charge, 0)} %`);
    if (mission) {
      const state = swiftlet.cdr.constantName(this.typeOf('mission_status'), '', mission.state);
      set('mission', mission.item_count ? `${state}, item ${mission.item_index + 1} of ${mission.item_count}` : state);
    }
    if (status) {
      const ms = (seconds) => (seconds < 0 ? '–' : number(1e3 * seconds, 1));
      set('pose', status.has_pose ? `${ms(status.pose_age_s)} ms old` : 'none');
      set('loop', `${ms(status.loop_delay_p50_s)} ms, p95 ${ms(status.loop_delay_p95_s)} ms`);
    }
    if (info) set('command', `${number(info.sense_to_actuate_p50_us, 0)} µs, p99 ${number(info.sense_to_actuate_p99_us, 0)} µs`);
  }

  // Of a message that has come, also when the connection is lost.
  typeOf(topic) {
    return this.client.types.get(`/${this.name}/${topic}`);
  }

  showStatus(status, age) {
    const silent = age > 1;
    const mode = swiftlet.cdr.constantName(this.typeOf('control_status'), 'MODE_', status.mode);
    this.mode.textContent = silent ? `silent for ${age.toFixed(0)} s` : mode;
    this.mode.classList.toggle('silent', silent);
    this.mode.style.setProperty('--band', `var(--mode-${mode.replace(/ /g, '-')}, var(--grid))`);
    this.reason.textContent = status.reason;
  }
};

// Sends a request to vehicles, once it is confirmed.
swiftlet.requestOf = async (vehicles, kind) => {
  const names = vehicles.map(({name}) => name).join(', ');
  const [title, text, label] = {
    hold: [`Hold ${names}?`, 'Brake and hold.', 'Hold'],
    land: [`Land ${names}?`, 'Descend vertically and land.', 'Land'],
    stop: [`Stop the rotors of ${names}?`, 'The rotors are turned off at once: a vehicle in the air falls.', 'Stop the rotors'],
  }[kind];
  const dialog = document.getElementById('confirm');
  const button = document.getElementById('confirm-yes');
  document.getElementById('confirm-title').textContent = title;
  document.getElementById('confirm-text').textContent = text;
  button.textContent = label;
  button.classList.toggle('danger', kind === 'stop');
  dialog.returnValue = '';
  dialog.showModal();
  document.getElementById(kind === 'stop' ? 'confirm-no' : 'confirm-yes').focus();
  await new Promise((resolve) => dialog.addEventListener('close', resolve, {once: true}));
  if (dialog.returnValue !== 'yes') return;
  const accepted = await Promise.all(vehicles.map((vehicle) => vehicle.request(kind)));
  const named = (success) => vehicles.filter((_, i) => accepted[i] === success).map(({name}) => name).join(', ');
  document.getElementById('answers').textContent =
    [['accepted by', named(true)], ['not accepted by', named(false)]]
      .filter(([, who]) => who).map(([what, who]) => `${kind} ${what} ${who}`).join('; ');
};
