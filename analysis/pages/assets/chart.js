// A chart of signals over the shared time axis, drawn by dygraphs.
'use strict';

swiftlet.charts = [];  // of the page

swiftlet.Chart = class {
  // spec: {title, unit, series: [{label, colour, role, load}]}. role: 'value', 'reference' (thin), 'limit' (dashed) or
  // 'bound' (dashed, also with the other sign); load() resolves to {t, y}.
  constructor(parent, spec, axis) {
    this.spec = spec;
    this.axis = axis;
    this.stale = true;   // what is drawn does not show the range of the axis
    this.visible = false;
    this.element = swiftlet.element('section', {class: 'chart'});
    this.element.append(swiftlet.element('h3', {}, spec.unit ? `${spec.title}, ${spec.unit}` : spec.title));
    this.legend = swiftlet.element('div', {class: 'legend'});
    this.plot = swiftlet.element('div', {class: 'plot', role: 'img', 'aria-label': spec.title});
    this.hairline = swiftlet.element('div', {class: 'hairline'});
    this.element.append(this.legend, this.plot, this.table());
    parent.append(this.element);
    swiftlet.charts.push(this);
    new IntersectionObserver((entries) => {
      this.visible = entries[entries.length - 1].isIntersecting;
      this.update();
    }, {rootMargin: '200px'}).observe(this.element);
    axis.on('range', () => this.markStale());
    axis.on('cursor', () => this.showCursor());
    swiftlet.theme.onChange(() => this.restyle());
    new ResizeObserver(() => this.resize()).observe(this.plot);
  }

  async load() {
    const signals = await Promise.all(this.spec.series.map((series) => series.load()));
    this.lines = [];
    this.spec.series.forEach((series, i) => {
      const {t, y} = signals[i];
      this.lines.push({...series, series: i, t, y});
      if (series.role === 'bound') this.lines.push({...series, series: i, t, y: y.map((value) => -value)});
    });
    this.shown = this.spec.series.map(() => true);
    this.makeLegend();
    this.describe();
  }

  makeLegend() {
    this.values = this.spec.series.map((series, i) => {
      const value = swiftlet.element('span', {class: 'number'});
      const button = swiftlet.element('button', {type: 'button', class: `key ${series.role}`, 'aria-pressed': 'true'});
      button.style.setProperty('--key', `var(--${this.colourName(series)})`);
      button.append(swiftlet.element('span', {class: 'swatch'}), series.label, value);
      button.addEventListener('click', () => {
        this.shown[i] = !this.shown[i];
        button.setAttribute('aria-pressed', String(this.shown[i]));
        this.graph.updateOptions({visibility: this.lines.map((line) => this.shown[line.series])});
      });
      this.legend.append(button);
      return value;
    });
  }

  colourName(series) {
    return series.role === 'limit' ? 'limit' : 'series-' + (series.colour % 8);
  }

  statistics(line) {
    let [count, sum, squares, least, most] = [0, 0, 0, Infinity, -Infinity];
    for (const value of line.y) {
      if (Number.isNaN(value)) continue;
      ++count;
      sum += value;
      squares += value * value;
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
    return {count, least, most, mean: sum / count, rms: Math.sqrt(squares / count)};
  }

  describe() {
    const texts = this.spec.series.map((series, i) => {
      const {count, least, most} = this.statistics(this.lines.find((line) => line.series === i));
      const range = count ? `${swiftlet.number(least)} to ${swiftlet.number(most)}` : 'no values';
      return `${series.label} ${range}`;
    });
    this.plot.setAttribute('aria-label', `${this.spec.title} over time, ${this.spec.unit}: ${texts.join('; ')}`);
  }

  // The figures of the whole log as a table, made when it is opened.
  table() {
    const details = swiftlet.element('details');
    details.append(swiftlet.element('summary', {}, 'as a table'));
    details.addEventListener('toggle', async () => {
      if (!details.open || details.querySelector('table')) return;
      if (!this.loading) this.loading = this.load();
      await this.loading;
      const rows = this.spec.series.map((series, i) => {
        const {count, least, most, mean, rms} = this.statistics(this.lines.find((line) => line.series === i));
        return [series.label, String(count), ...[least, mean, rms, most].map(swiftlet.number)];
      });
      details.append(swiftlet.table([this.spec.unit, 'values', 'least', 'mean', 'RMS', 'largest'], rows));
    });
    return details;
  }

  markStale() {
    this.stale = true;
    this.update();
  }

  // Draws at most once a frame, and only what is on the screen.
  update() {
    if (!this.stale || !this.visible || this.planned) return;
    this.planned = true;
    requestAnimationFrame(async () => {
      if (!this.loading) this.loading = this.load();
      await this.loading;
      this.planned = false;
      this.stale = false;
      this.draw();
    });
  }

  // Rows [time, value of each line], null where a line has no point.
  rows() {
    const [from, to] = this.axis.range;
    const intervals = Math.max(100, Math.round(this.plot.clientWidth / 1.5));
    const sampled = this.lines.map((line) => swiftlet.downsample(line, from, to, intervals));
    const times = new Set();
    for (const {t} of sampled) t.forEach((time) => times.add(time));
    const rows = Float64Array.from(times).sort();
    const next = sampled.map(() => 0);
    return Array.from(rows, (time) => {
      const row = [time];
      sampled.forEach(({t, y}, i) => {
        let value = null;
        while (next[i] < t.length && t[next[i]] === time) value = y[next[i]++];
        row.push(value);
      });
      return row;
    });
  }

  draw() {
    const rows = this.rows();
    if (!rows.length) return;
    this.drawing = true;
    if (this.graph) this.graph.updateOptions({file: rows, dateWindow: [...this.axis.range]});
    else this.graph = new Dygraph(this.plot, rows, this.options());
    this.drawing = false;
    this.plot.append(this.hairline);
    this.showCursor();
  }

  options() {
    return {
      labels: ['time', ...this.lines.map((line, i) => `${i}`)],
      ...this.colours(),
      series: Object.fromEntries(this.lines.map((line, i) => [`${i}`, this.lineStyle(line)])),
      dateWindow: [...this.axis.range],
      connectSeparatedPoints: true,
      legend: 'never',
      highlightCircleSize: 0,
      axes: {
        x: {axisLabelFormatter: (time) => swiftlet.number(time), axisLabelWidth: 60},
        y: {axisLabelWidth: 52, axisLabelFormatter: (value) => swiftlet.number(value)},
      },
      xRangePad: 0,
      rightGap: 8,
      interactionModel: this.interaction(),
      highlightCallback: (event, time) => this.axis.setCursor(this.graph.toDataXCoord(event.offsetX)),
      drawCallback: (graph) => this.follow(graph),
      zoomCallback: (from, to) => this.axis.setRange(from, to),
    };
  }

  lineStyle(line) {
    if (line.role === 'value') return {strokeWidth: 1.4};
    if (line.role === 'reference') return {strokeWidth: 1.1, strokePattern: [6, 3]};
    return {strokeWidth: 1, strokePattern: [2, 3]};
  }

  colours() {
    return {
      colors: this.lines.map((line) => swiftlet.theme.colour(this.colourName(line))),
      gridLineColor: swiftlet.theme.colour('grid'),
      axisLineColor: swiftlet.theme.colour('axis'),
    };
  }

  // One finger scrolls the page, two zoom and move the range.
  interaction() {
    const model = Dygraph.defaultInteractionModel;
    const withTwo = (handler) => (event, graph, context) => {
      if (event.touches.length > 1 || context.initialTouches?.length > 1) handler(event, graph, context);
    };
    return {
      ...model,
      touchstart: withTwo(model.touchstart),
      touchmove: withTwo(model.touchmove),
      touchend: withTwo(model.touchend),
      dblclick: () => {
        this.axis.reset();
        this.graph.updateOptions({valueRange: null});
      },
    };
  }

  // The axis takes the range to which dygraphs was moved by hand.
  follow(graph) {
    if (this.drawing || !this.graph) return;
    const [from, to] = graph.xAxisRange();
    this.axis.setRange(from, to);
  }

  showCursor() {
    if (!this.graph || !this.visible) return;
    const [from, to] = this.axis.range;
    const inside = this.axis.cursor >= from && this.axis.cursor <= to;
    this.hairline.hidden = !inside;
    if (inside) this.hairline.style.left = `${this.graph.toDomXCoord(this.axis.cursor)}px`;
    this.spec.series.forEach((series, i) => {
      const {t, y} = this.lines.find((line) => line.series === i);
      const at = swiftlet.columns.indexAt(t, this.axis.cursor);
      this.values[i].textContent = at < 0 || Number.isNaN(y[at]) ? '' : swiftlet.number(y[at]);
    });
  }

  restyle() {
    if (this.graph) this.graph.updateOptions(this.colours());
  }

  resize() {
    if (!this.graph || this.plot.clientWidth === this.graph.width_) return;
    this.graph.resize();
    this.markStale();
  }
};
