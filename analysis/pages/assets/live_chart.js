// A chart whose signals grow, of all vehicles.
'use strict';

swiftlet.LiveChart = class extends swiftlet.Chart {
  // spec: as of Chart; each of the series has `now`, which gives its {t, y}.
  constructor(parent, spec, axis) {
    super(parent, spec, axis);
    this.element.querySelector('details').remove();  // a table of what changes
  }

  // Of more vehicles.
  setSeries(series) {
    this.spec.series = series;
    if (this.graph) this.graph.destroy();
    this.graph = null;
    this.loading = null;
    this.legend.replaceChildren();
    this.markStale();
  }

  renew() {
    for (const line of this.lines) Object.assign(line, line.now());
  }

  draw() {
    this.renew();
    super.draw();
  }
};
