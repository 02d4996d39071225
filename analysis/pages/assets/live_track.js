// Columns of numbers over time that grow at their end; the oldest half is forgotten when they are full.
'use strict';

swiftlet.Track = class {
  constructor(names) {
    this.length = 0;
    this.t = new Float64Array(swiftlet.Track.capacity);
    this.columns = Object.fromEntries(names.map((name) => [name, new Float32Array(swiftlet.Track.capacity)]));
  }

  // values: one for each column, in order. A time that is not after the last one is left out.
  push(time, values) {
    if (this.length && time <= this.t[this.length - 1]) return;
    if (this.length === swiftlet.Track.capacity) this.forget();
    this.t[this.length] = time;
    Object.values(this.columns).forEach((column, i) => { column[this.length] = values[i]; });
    this.length += 1;
  }

  forget() {
    const half = swiftlet.Track.capacity / 2;
    for (const column of [this.t, ...Object.values(this.columns)]) column.copyWithin(0, half);
    this.length = half;
  }

  times() {
    return this.t.subarray(0, this.length);
  }

  column(name) {
    return this.columns[name].subarray(0, this.length);
  }
};

swiftlet.Track.capacity = 60000;  // at 50 Hz the last 10 to 20 minutes
