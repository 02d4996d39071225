// Reads the columns of numbers that packed_column.cpp wrote into the page.
'use strict';
const swiftlet = {};

swiftlet.columns = (() => {
  const decoded = new Map();  // promises by the id of their element

  async function inflated(id) {
    const text = document.getElementById(id).textContent;
    const compressed = await (await fetch('data:application/octet-stream;base64,' + text)).arrayBuffer();
    const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  }

  // The bytes stand by significance.
  function words(planes) {
    const count = planes.length / 4;
    const bytes = new Uint8Array(planes.length);
    for (let plane = 0; plane < 4; ++plane) {
      for (let i = 0; i < count; ++i) bytes[4 * i + plane] = planes[plane * count + i];
    }
    return bytes.buffer;
  }

  // Resolves to the numbers of a column.
  async function numbers(id) {
    return new Float32Array(words(await inflated(id)));
  }

  async function times(id, start) {
    const steps = new Uint32Array(words(await inflated(id)));
    const out = new Float64Array(steps.length);
    let microseconds = 0;
    for (let i = 0; i < steps.length; ++i) {
      microseconds += steps[i];
      out[i] = start + microseconds * 1e-6;
    }
    return out;
  }

  function once(id, read) {
    if (!decoded.has(id)) decoded.set(id, read());
    return decoded.get(id);
  }

  // table: {start, time, signals} with ids of elements. Resolves to {t, y}, s and the signal's values.
  async function signal(table, name) {
    const id = table.signals[name];
    const [t, y] = await Promise.all(
        [once(table.time, () => times(table.time, table.start)), once(id, () => numbers(id))]);
    return {t, y};
  }

  // The last index whose time is not after `time`; -1 if all are.
  function indexAt(t, time) {
    let low = 0;
    let high = t.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (t[middle] <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  return {numbers, signal, indexAt};
})();
