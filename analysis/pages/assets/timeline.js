// Modes as bands and events as marks over the shared time axis, a row for each flight.
'use strict';

swiftlet.Timeline = class {
  // flights: [{name, modes: [[time, mode]], events: [[time, kind, text, warning]], end}]
  constructor(parent, flights, axis) {
    this.axis = axis;
    this.marks = [];
    for (const flight of flights) {
      parent.append(swiftlet.element('div', {class: 'row-name'}, flight.name));
      const row = swiftlet.element('div', {class: 'timeline'});
      flight.modes.forEach(([time, mode], i) => {
        const end = i + 1 < flight.modes.length ? flight.modes[i + 1][0] : flight.end;
        const band = swiftlet.element('span', {class: 'mode', title: mode}, mode);
        band.style.setProperty('--band', `var(--mode-${mode.replace(/ /g, '-')}, var(--grid))`);
        row.append(band);
        this.marks.push({element: band, time, end});
      });
      flight.events.forEach(([time, kind, text, warning]) => {
        if (kind === 'mode') return;
        const mark = swiftlet.element('button', {
          type: 'button', class: warning ? 'mark warning' : 'mark', title: `${swiftlet.number(time)} s: ${text}`,
          'aria-label': `${swiftlet.number(time)} s: ${text}`, tabindex: '-1',
        });
        mark.addEventListener('click', () => axis.setCursor(time));
        row.append(mark);
        this.marks.push({element: mark, time});
      });
      const hairline = swiftlet.element('div', {class: 'hairline'});
      row.append(hairline);
      this.marks.push({element: hairline, cursor: true});
      row.addEventListener('click', (event) => {
        if (event.target.classList.contains('mark')) return;
        const {left, width} = row.getBoundingClientRect();
        axis.setCursor(axis.range[0] + (event.clientX - left) / width * (axis.range[1] - axis.range[0]));
      });
      parent.append(row);
    }
    axis.on('range', () => this.place());
    axis.on('cursor', () => this.place());
    this.place();
  }

  place() {
    const [from, to] = this.axis.range;
    const percent = (time) => 100 * (time - from) / (to - from);
    for (const {element, time, end, cursor} of this.marks) {
      const at = cursor ? this.axis.cursor : time;
      const left = percent(at);
      if (end === undefined) {
        element.hidden = left < 0 || left > 100;
        element.style.left = `${left}%`;
        continue;
      }
      const begin = Math.max(0, left);
      const width = Math.min(100, percent(end)) - begin;
      element.hidden = width <= 0;
      element.style.left = `${begin}%`;
      element.style.width = `${width}%`;
    }
  }
};
