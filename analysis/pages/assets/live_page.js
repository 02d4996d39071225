// The page of running vehicles.
'use strict';

swiftlet.livePage = (() => {
  const get = (id) => document.getElementById(id);
  const mostEvents = 200;
  // Charts that are there from the start: [title, unit, scale, [topic, signal, role]...].
  const panels = [
    ['North', 'm', 1, ['estimate', 'position_ned[0]', 'value'], ['reference', 'position_ned[0]', 'reference']],
    ['East', 'm', 1, ['estimate', 'position_ned[1]', 'value'], ['reference', 'position_ned[1]', 'reference']],
    ['Height', 'm', -1, ['estimate', 'position_ned[2]', 'value'], ['reference', 'position_ned[2]', 'reference']],
    ['Supply voltage', 'V', 1, ['battery', 'voltage_v', 'value']],
    ['Delay of the loop, p95', 'ms', 1e3, ['control_status', 'loop_delay_p95_s', 'value']],
    ['IMU to command, p99', 'µs', 1, ['vehicle_info', 'sense_to_actuate_p99_us', 'value']],
  ];
  const vehicles = [];
  const charts = [];
  const topics = new Map();  // types by the name of the topic, "imu"
  const clock = {start: null, server: 0, page: 0};
  let axis, client, scene;
  let following = true;
  let refreshing = false;
  let chosenTopic = 'estimate';

  // s since the first message, by the clock of the server.
  function time(server) {
    clock.start ??= server;
    if (server > clock.server) Object.assign(clock, {server, page: performance.now() / 1e3});
    return server - clock.start;
  }
  const serverNow = () => clock.server + performance.now() / 1e3 - clock.page;

  function series([, , scale, ...lines]) {
    return vehicles.flatMap((vehicle) => lines.map(([topic, signal, role]) => {
      const now = vehicle.signal(topic, signal, scale);
      const label = role === 'reference' ? `${vehicle.name} reference` : vehicle.name;
      return {label, role, colour: vehicle.colour, now, load: async () => now()};
    }));
  }

  function addChart(panel) {
    const chart = new swiftlet.LiveChart(get('charts'), {title: panel[0], unit: panel[1], series: series(panel)}, axis);
    charts.push({panel, chart});
    return chart;
  }

  function addVehicle(name) {
    const vehicle = new swiftlet.LiveVehicle(name, vehicles.length, client, {event: addEvent, time});
    vehicles.push(vehicle);
    get('vehicles').append(vehicle.card);
    charts.forEach(({panel, chart}) => chart.setSeries(series(panel)));
  }

  // A vehicle is what has a control_status.
  function addChannel({topic, schema}) {
    const [, name, kind] = topic.split('/');
    if (kind === undefined) return;
    if (!topics.has(kind)) {
      topics.set(kind, swiftlet.cdr.parse(schema));
      listTopics();
    }
    if (kind === 'control_status' && !vehicles.some((vehicle) => vehicle.name === name)) addVehicle(name);
  }

  function listTopics() {
    const known = [...topics].filter(([, type]) => swiftlet.cdr.signals(type).length).map(([name]) => name).sort();
    get('topic').replaceChildren(...known.map((name) => swiftlet.element('option', {}, name)));
    get('topic').value = [chosenTopic, known[0]].find((name) => known.includes(name));
    listSignals();
  }

  function listSignals() {
    const names = swiftlet.cdr.signals(topics.get(get('topic').value));
    get('signal').replaceChildren(...names.map((name) => swiftlet.element('option', {}, name)));
    get('signal').value = names.find((name) => !/(stamp_ns|sequence_number)$/.test(name)) ?? names[0];
  }

  function addEvent(vehicle, at, text, warning) {
    const row = swiftlet.element('p', {class: warning ? 'warning' : 'finding'},
                                `${new Date(1e3 * at).toLocaleTimeString('en-GB')}  ${vehicle.name}: ${text}`);
    row.dataset.at = at;
    const rows = get('events').children;  // the newest first
    // A server that is connected again sends its last lines again.
    if ([...rows].some((other) => other.dataset.at === row.dataset.at && other.textContent === row.textContent)) return;
    get('events').insertBefore(row, [...rows].find((other) => Number(other.dataset.at) <= at) ?? null);
    if (rows.length > mostEvents) get('events').lastChild.remove();
  }

  function follow(on) {
    following = on;
    get('follow').setAttribute('aria-pressed', String(on));
  }

  // Ten times a second: charts and cards. The scene is drawn with each frame of the screen.
  function refresh() {
    if (clock.start === null) return;
    refreshing = true;
    axis.end = Math.max(axis.end, serverNow() - clock.start);
    if (following) {
      axis.setRange(axis.end - Number(get('window').value), axis.end);
      if (!document.querySelector('.plot:hover')) axis.setCursor(axis.end);
    }
    refreshing = false;
    vehicles.forEach((vehicle) => vehicle.show(serverNow()));
  }

  function draw() {
    if (following) scene.update();
    requestAnimationFrame(draw);
  }

  function addControls() {
    get('hold-all').addEventListener('click', () => swiftlet.requestOf([...vehicles], 'hold'));
    get('land-all').addEventListener('click', () => swiftlet.requestOf([...vehicles], 'land'));
    get('stop-all').addEventListener('click', () => swiftlet.requestOf([...vehicles], 'stop'));
    get('home').addEventListener('click', () => scene.home());
    get('map').addEventListener('click', () => scene.map());
    get('follow').addEventListener('click', () => follow(!following));
    get('topic').addEventListener('change', () => {
      chosenTopic = get('topic').value;
      listSignals();
    });
    get('add-signal').addEventListener('submit', (event) => {
      event.preventDefault();
      const [topic, signal] = [get('topic').value, get('signal').value];
      addChart([`${topic}.${signal}`, '', 1, [topic, signal, 'value']]).element.scrollIntoView({block: 'nearest'});
    });
    axis.on('range', () => refreshing || follow(false));
  }

  function url() {
    const query = new URLSearchParams(location.search);
    query.set('newest', '');
    return `ws://${location.host}/?${query}`;
  }

  function main() {
    axis = swiftlet.axis = new swiftlet.TimeAxis(0, 1e-3);
    panels.forEach(addChart);
    scene = swiftlet.scene = new swiftlet.LiveScene(get('scene'), vehicles, axis);
    scene.controls?.addEventListener('start', () => { scene.isTurned = true; });
    client = new swiftlet.Foxglove(url(), {
      state: (text, isOpen) => {
        get('connection').textContent = text;
        get('state').className = isOpen ? 'quiet' : 'warning';
        document.documentElement.dataset.ready = String(isOpen);
      },
      channel: addChannel,
      status: ({message}) => {
        get('slow').textContent = message;  // in a line that is there already: buttons must not move
      },
    });
    addControls();
    setInterval(refresh, 100);
    requestAnimationFrame(draw);
  }

  return {main, vehicles, charts};
})();

window.addEventListener('DOMContentLoaded', swiftlet.livePage.main);
