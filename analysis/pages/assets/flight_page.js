// The page of recorded flights: the data are in the page, as flight_page.cpp writes them.
'use strict';

swiftlet.flightPage = (() => {
  const has = (flight, table, signal) => flight.tables[table]?.signals[signal] !== undefined;
  const load = (flight, table, signal) => swiftlet.columns.signal(flight.tables[table], signal);

  function series(flight, [table, signal, role, label], colour, name) {
    return {label: name(label), role, colour, load: () => load(flight, table, signal)};
  }

  // With one flight a chart of all parts, with several a chart for each part.
  function charts(panel, flights) {
    const known = (part) => ({
      label: part.label,
      lines: flights.flatMap((flight, k) =>
        part.lines.filter(([table, signal]) => has(flight, table, signal)).map((line) => ({flight, k, line}))),
    });
    const parts = panel.parts.map(known).filter((part) => part.lines.length);
    if (!parts.length) return [];
    if (flights.length === 1) {
      return [{
        title: panel.title, unit: panel.unit,
        series: parts.flatMap((part, i) => part.lines.map(({flight, line}) =>
          series(flight, line, i, (label) => (label ? `${part.label} ${label}` : part.label)))),
      }];
    }
    return parts.map((part) => ({
      title: panel.parts.length > 1 ? `${panel.title}, ${part.label}` : panel.title, unit: panel.unit,
      series: part.lines.map(({flight, k, line}) =>
        series(flight, line, k, (label) => (label ? `${flight.name}, ${label}` : flight.name))),
    }));
  }

  async function sceneOf(flight, colour) {
    const columns = async (table, names) => {
      const signals = await Promise.all(names.map((name) => load(flight, table, name)));
      return [signals[0].t, ...signals.map(({y}) => y)];
    };
    const position = ['north', 'east', 'down'];
    const [t, north, east, down, ...q] = await columns('path', [...position, 'q[0]', 'q[1]', 'q[2]', 'q[3]']);
    const out = {name: flight.name, colour, path: {t, north, east, down, q}, fence: flight.fence};
    if (has(flight, 'reference', 'north')) {
      const [rt, rn, re, rd] = await columns('reference', position);
      out.reference = {t: rt, north: rn, east: re, down: rd};
    }
    return out;
  }

  function addControls(axis, home) {
    const get = (id) => document.getElementById(id);
    const slider = get('time');
    slider.min = axis.start;
    slider.max = axis.end;
    slider.step = (axis.end - axis.start) / 10000;
    const show = () => {
      slider.value = axis.cursor;
      slider.setAttribute('aria-valuetext', `${axis.cursor.toFixed(2)} s`);
      get('time-text').textContent = `${axis.cursor.toFixed(2)} s`.replace('-', '−');
    };
    axis.on('cursor', show);
    show();
    slider.addEventListener('input', () => axis.setCursor(Number(slider.value)));
    get('zoom-in').addEventListener('click', () => axis.zoom(0.5));
    get('zoom-out').addEventListener('click', () => axis.zoom(2));
    get('earlier').addEventListener('click', () => axis.move(-0.5));
    get('later').addEventListener('click', () => axis.move(0.5));
    get('whole').addEventListener('click', () => axis.reset());
    get('home').addEventListener('click', home);
    addPlayer(get('play'), axis);
  }

  function addPlayer(button, axis) {
    let last = null;
    const step = (now) => {
      if (last === null) return;
      axis.setCursor(axis.cursor + (now - last) / 1000);
      last = now;
      if (axis.cursor < axis.end) requestAnimationFrame(step);
      else stop();
    };
    const stop = () => {
      last = null;
      button.textContent = 'Play';
    };
    button.addEventListener('click', () => {
      if (last !== null) return stop();
      if (axis.cursor >= axis.end) axis.setCursor(axis.start);
      last = performance.now();
      button.textContent = 'Pause';
      requestAnimationFrame(step);
    });
  }

  function addCharts(flights, axis) {
    const parent = document.getElementById('charts');
    let group = null;
    let grid = null;
    for (const panel of swiftlet.flightPanels) {
      const specs = charts(panel, flights);
      if (specs.length && panel.group !== group) {
        group = panel.group;
        grid = swiftlet.element('div', {class: 'grid'});
        parent.append(swiftlet.element('h2', {}, group), grid);
      }
      specs.forEach((spec) => new swiftlet.Chart(grid, spec, axis));
    }
  }

  function linkEvents(axis) {
    document.querySelectorAll('#events [data-time]').forEach((cell) => {
      const button = swiftlet.element('button', {type: 'button', class: 'link'}, cell.textContent);
      button.addEventListener('click', () => axis.setCursor(Number(cell.dataset.time)));
      cell.replaceChildren(button);
    });
  }

  async function main() {
    const flights = JSON.parse(document.getElementById('flights').textContent);
    const start = Math.min(...flights.map((flight) => flight.start));
    const end = Math.max(...flights.map((flight) => flight.end));
    const axis = new swiftlet.TimeAxis(start, end);
    swiftlet.axis = axis;
    new swiftlet.Timeline(document.getElementById('timeline'), flights, axis);
    addCharts(flights, axis);
    linkEvents(axis);
    const scene = new swiftlet.Scene(document.getElementById('scene'), await Promise.all(flights.map(sceneOf)), axis);
    addControls(axis, () => scene.home());
    axis.setCursor(Math.min(Math.max(0, start), end));
    document.documentElement.dataset.ready = 'true';
  }

  return {main};
})();

window.addEventListener('DOMContentLoaded', swiftlet.flightPage.main);
