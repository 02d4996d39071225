// Fewer points that show the same line: the least and the largest of each interval, in their order.
'use strict';

swiftlet.downsample = (() => {
  // The points of a signal {t, y} from `from` to `to` and one beyond each end, two for each of `intervals` intervals; all
  // if there are not many more. NaN interrupts the line.
  return ({t, y}, from, to, intervals) => {
    const first = Math.max(0, swiftlet.columns.indexAt(t, from));
    const last = Math.min(t.length, swiftlet.columns.indexAt(t, to) + 2);
    const count = last - first;
    if (count <= 4 * intervals) return {t: t.subarray(first, last), y: y.subarray(first, last)};
    const times = new Float64Array(2 * intervals);
    const values = new Float64Array(2 * intervals);
    let length = 0;
    const put = (i) => {
      times[length] = t[i];
      values[length++] = y[i];
    };
    for (let k = 0; k < intervals; ++k) {
      const begin = first + Math.floor(k * count / intervals);
      const end = first + Math.floor((k + 1) * count / intervals);
      let low = -1;
      let high = -1;
      for (let i = begin; i < end; ++i) {
        if (Number.isNaN(y[i])) continue;
        if (low < 0 || y[i] < y[low]) low = i;
        if (high < 0 || y[i] > y[high]) high = i;
      }
      if (low < 0) {
        put(begin);
      } else {
        put(Math.min(low, high));
        if (low !== high) put(Math.max(low, high));
      }
    }
    return {t: times.subarray(0, length), y: values.subarray(0, length)};
  };
})();
