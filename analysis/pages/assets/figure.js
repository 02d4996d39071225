// A panel of a figure (figure.hpp): dygraphs draws axes and grid, and zooms; the series are drawn over them.
'use strict';

swiftlet.Figure = class {
  constructor(element) {
    this.panel = JSON.parse(element.dataset.panel);
    this.plot = swiftlet.element('div', {class: 'plot', role: 'img', 'aria-label': this.panel.caption});
    this.plot.style.height = `${this.panel.height}px`;
    element.prepend(this.legend(), swiftlet.element('div', {class: 'axis-label'}, this.panel.y.label), this.plot,
                    swiftlet.element('div', {class: 'axis-label below'}, this.panel.x.label));
    element.append(this.table());
    swiftlet.figures.push(this);
    swiftlet.theme.onChange(() => this.graph.updateOptions(this.colours()));
    new ResizeObserver(() => this.graph && this.graph.resize()).observe(this.plot);
  }

  legend() {
    const legend = swiftlet.element('div', {class: 'legend'});
    for (const {label, style, colour} of this.panel.series) {
      if (!label) continue;
      const key = swiftlet.element('span', {class: `key ${style}`});
      key.style.setProperty('--key', `var(--${colour})`);
      key.append(swiftlet.element('span', {class: 'swatch'}), label);
      legend.append(key);
    }
    return legend;
  }

  async draw() {
    const read = async (series) => ({
      ...series, xs: await swiftlet.columns.numbers(series.x), ys: await swiftlet.columns.numbers(series.y),
    });
    this.series = await Promise.all(this.panel.series.map(read));
    this.x = this.limits(this.panel.x, (series) => series.xs);
    this.y = this.limits(this.panel.y, (series) => series.ys, this.panel.zero_line ? 0 : NaN);
    this.describe();
    // Two points without a line give dygraphs the extent.
    this.graph = new Dygraph(this.plot, [[this.x[0], this.y[0]], [this.x[1], this.y[1]]], {
      ...this.colours(), labels: ['x', 'y'], strokeWidth: 0, legend: 'never', highlightCircleSize: 0,
      dateWindow: this.x, valueRange: this.y, logscale: this.panel.y.logarithmic, xRangePad: 0, rightGap: 8,
      axes: {
        x: {...this.labels(this.panel.x), logscale: this.panel.x.logarithmic, axisLabelWidth: 60},
        y: {...this.labels(this.panel.y), axisLabelWidth: 52},
      },
      interactionModel: {
        ...Dygraph.defaultInteractionModel,
        touchstart: () => {}, touchmove: () => {}, touchend: () => {},
        dblclick: () => this.graph.updateOptions({dateWindow: this.x, valueRange: this.y}),
      },
      underlayCallback: (context, area, graph) => this.paint(context, graph),
    });
  }

  colours() {
    return {
      colors: ['transparent'], gridLineColor: swiftlet.theme.colour('grid'), axisLineColor: swiftlet.theme.colour('axis'),
    };
  }

  labels({names}) {
    if (!names.length) return {axisLabelFormatter: (value) => swiftlet.number(value)};
    return {ticker: () => names.map((label, i) => ({v: i + 1, label}))};
  }

  // Of an axis: those given, else those of the data with a margin.
  limits({from, to, least_span: leastSpan, logarithmic}, valuesOf, also = NaN) {
    const usable = (value) => Number.isFinite(value) && (!logarithmic || value > 0);
    let [low, high] = swiftlet.extent(usable(also) ? [also] : []);
    for (const series of this.series) {
      const [least, most] = swiftlet.extent(valuesOf(series).filter(usable));
      low = Math.min(low, least);
      high = Math.max(high, most);
    }
    if (low > high) [low, high] = logarithmic ? [1, 10] : [0, 1];
    if (logarithmic) return [from ?? low / 1.25, to ?? high * 1.25];
    const span = Math.max(high - low, leastSpan, 1e-9 * Math.max(Math.abs(low), Math.abs(high)), 1e-12);
    const middle = (low + high) / 2;
    return [from ?? middle - 0.54 * span, to ?? middle + 0.54 * span];
  }

  describe() {
    const range = ([from, to]) => `${swiftlet.number(from)} to ${swiftlet.number(to)}`;
    const names = this.series.map(({label}) => label).filter((label) => label).join(', ');
    this.plot.setAttribute('aria-label', `${this.panel.caption}. ${this.panel.x.label || 'x'}: ${range(this.x)}; ` +
        `${this.panel.y.label || 'y'}: ${range(this.y)}${names ? `; shown: ${names}` : ''}`);
  }

  // The points of each series with a name, at most 500 of each.
  table() {
    const details = swiftlet.element('details');
    details.append(swiftlet.element('summary', {}, 'as a table'));
    details.addEventListener('toggle', () => {
      if (!details.open || details.querySelector('table')) return;
      const rows = this.series.flatMap(({label, xs, ys}) => {
        const step = Math.ceil(xs.length / 500);
        return Array.from({length: Math.ceil(xs.length / step)}, (_, i) =>
          [label, swiftlet.number(xs[i * step]), swiftlet.number(ys[i * step])]);
      });
      details.append(swiftlet.table(['', this.panel.x.label || 'x', this.panel.y.label || 'y'], rows));
    });
    return details;
  }

  // Of a value on the x axis, px. dygraphs' toDomXCoord() knows no logarithmic x axis.
  xOf(value, graph) {
    if (!this.panel.x.logarithmic) return graph.toDomXCoord(value);
    const {x, w} = graph.getArea();
    const [from, to] = graph.xAxisRange();
    return x + w * Math.log(value / from) / Math.log(to / from);
  }

  paint(context, graph) {
    const {x, y, w, h} = graph.getArea();
    context.save();
    context.beginPath();
    context.rect(x, y, w, h);
    context.clip();
    if (this.panel.zero_line) {
      context.strokeStyle = swiftlet.theme.colour('axis');
      context.strokeRect(x - 1, graph.toDomYCoord(0), w + 2, 0);
    }
    for (const series of this.series) {
      context.strokeStyle = context.fillStyle = swiftlet.theme.colour(series.colour);
      context.lineWidth = 1.6 * series.weight;
      context.setLineDash(series.style === 'dashes' ? [7, 5] : []);
      const places = Array.from(series.xs, (value, i) => [this.xOf(value, graph), graph.toDomYCoord(series.ys[i])]);
      swiftlet.Figure.painters[series.style](context, places, series, graph);
    }
    context.restore();
  }
};

swiftlet.figures = [];  // of the page

swiftlet.Figure.painters = (() => {
  // A point that is not finite interrupts the line.
  const trace = (context, places, lineTo) => {
    context.beginPath();
    let last = null;
    for (const place of places) {
      if (!place.every(Number.isFinite)) last = null;
      else if (last === null) context.moveTo(...(last = place));
      else lineTo(last, last = place);
    }
  };
  const line = (context, places) => {
    trace(context, places, (last, [x, y]) => context.lineTo(x, y));
    context.stroke();
  };
  const steps = (context, places) => {
    trace(context, places, (last, [x, y]) => {
      context.lineTo(x, last[1]);
      context.lineTo(x, y);
    });
    context.stroke();
  };
  const dots = (context, places, {weight}) => {
    const radius = (places.length > 200 ? 1.8 : 2.6) * weight;
    context.globalAlpha = places.length > 2000 ? 0.5 : 0.85;
    for (const [x, y] of places) {
      context.beginPath();
      context.arc(x, y, radius, 0, 2 * Math.PI);
      context.fill();
    }
    context.globalAlpha = 1;
  };
  const crosses = (context, places) => {
    context.beginPath();
    for (const [x, y] of places) {
      context.moveTo(x - 4, y - 4);
      context.lineTo(x + 4, y + 4);
      context.moveTo(x - 4, y + 4);
      context.lineTo(x + 4, y - 4);
    }
    context.stroke();
  };
  const band = (context, places) => {
    trace(context, places, (last, [x, y]) => context.lineTo(x, y));
    context.closePath();
    context.globalAlpha = 0.25;
    context.fill();
    context.globalAlpha = 1;
  };
  // Box of the quartiles, whiskers to 90 % of the values, a dot for each value beyond.
  const boxes = (context, places, {xs, ys}, graph) => {
    const sorted = ys.slice().sort();
    if (!sorted.length) return;
    const at = (share) => graph.toDomYCoord(sorted[Math.round(share * (sorted.length - 1))]);
    const x = places[0][0];
    const half = 0.25 * Math.abs(graph.toDomXCoord(xs[0] + 1) - x);
    const [bottom, low, middle, high, top] = [0.05, 0.25, 0.5, 0.75, 0.95].map(at);
    context.globalAlpha = 0.25;
    context.fillRect(x - half, high, 2 * half, low - high);
    context.globalAlpha = 1;
    context.strokeRect(x - half, high, 2 * half, low - high);
    context.beginPath();
    for (const [x0, y0, x1, y1] of [[x - half, middle, x + half, middle], [x, low, x, bottom], [x, high, x, top],
                                    [x - half / 2, bottom, x + half / 2, bottom], [x - half / 2, top, x + half / 2, top]]) {
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
    }
    context.stroke();
    dots(context, places.filter(([, y]) => y > bottom || y < top), {weight: 0.7});
  };
  return {line, dashes: line, steps, dots, crosses, band, boxes};
})();

window.addEventListener('DOMContentLoaded', async () => {
  const figures = [...document.querySelectorAll('figure[data-panel]')].map((element) => new swiftlet.Figure(element));
  await Promise.all(figures.map((figure) => figure.draw()));
  document.documentElement.dataset.ready = 'true';
});
