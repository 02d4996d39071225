// The time axis that charts, timeline and scene share: the range that is shown, and the cursor.
'use strict';

swiftlet.TimeAxis = class {
  constructor(start, end) {
    this.start = start;
    this.end = end;
    this.range = [start, end];
    this.cursor = start;
    this.listeners = {range: [], cursor: []};
  }

  on(what, listener) {
    this.listeners[what].push(listener);
  }

  tell(what) {
    for (const listener of this.listeners[what]) listener();
  }

  // Keeps inside of the log, and at least a millisecond.
  setRange(from, to) {
    const length = Math.min(Math.max(to - from, 1e-3), this.end - this.start);
    const begin = Math.min(Math.max(from, this.start), this.end - length);
    if (begin === this.range[0] && begin + length === this.range[1]) return;
    this.range = [begin, begin + length];
    this.tell('range');
  }

  reset() {
    this.setRange(this.start, this.end);
  }

  // Around the cursor if it is shown, else around the middle.
  zoom(factor) {
    const [from, to] = this.range;
    const centre = this.cursor >= from && this.cursor <= to ? this.cursor : (from + to) / 2;
    this.setRange(centre - (centre - from) * factor, centre + (to - centre) * factor);
  }

  move(share) {
    const shift = share * (this.range[1] - this.range[0]);
    this.setRange(this.range[0] + shift, this.range[1] + shift);
  }

  setCursor(time) {
    const inside = Math.min(Math.max(time, this.start), this.end);
    if (inside === this.cursor) return;
    this.cursor = inside;
    this.tell('cursor');
  }
};
