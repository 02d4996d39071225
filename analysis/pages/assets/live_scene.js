// Vehicles with their paths and references, as they fly.
'use strict';

swiftlet.LiveScene = class extends swiftlet.Scene {
  // vehicles: as the flights of Scene, with columns that grow: path and reference give the present ones.
  description() {
    return 'Vehicles, their paths and references in space';
  }

  // Where the vehicles are and were, and a room about the origin.
  bounds() {
    const box = new THREE.Box3(new THREE.Vector3(-1, 0, -1), new THREE.Vector3(1, 1, 1));
    for (const {path: {t, north, east, down}} of this.flights) {
      if (!t.length) continue;
      const [n, e, d] = [north, east, down].map(swiftlet.extent);
      box.expandByPoint(swiftlet.Scene.fromNed(n[0], e[0], d[0]));
      box.expandByPoint(swiftlet.Scene.fromNed(n[1], e[1], d[1]));
    }
    return box;
  }

  build() {
    this.lines = [];
    super.build();
  }

  line(track, colour, of) {
    const geometry = new THREE.BufferGeometry();
    const points = new THREE.BufferAttribute(new Float32Array(3 * swiftlet.LiveScene.mostPoints), 3);
    geometry.setAttribute('position', points);
    const line = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour}));
    line.frustumCulled = false;
    this.lines.push({geometry, points, of});
    return line;
  }

  addFlight(flight) {
    const colour = swiftlet.theme.series(flight.colour);
    this.scene.add(this.line(null, colour, () => flight.path),
                   this.line(null, swiftlet.theme.colour('muted'), () => flight.reference));
    const vehicle = this.vehicle(colour);
    this.scene.add(vehicle);
    return vehicle;
  }

  // The newest of what has come.
  update() {
    if (!this.renderer) return;
    this.grow();
    for (const {geometry, points, of} of this.lines) {
      const {t, north, east, down} = of();
      const step = Math.ceil(t.length / swiftlet.LiveScene.mostPoints) || 1;
      let count = 0;
      for (let i = (t.length - 1) % step; i < t.length; i += step, ++count)
        points.setXYZ(count, east[i], -down[i], -north[i]);
      geometry.setDrawRange(0, count);
      points.needsUpdate = true;
    }
    this.place();
  }

  // Shows more room once a vehicle leaves what is shown.
  grow() {
    const leaves = this.flights.length !== this.vehicles.length || this.flights.some(({path: {t, north, east, down}}) => {
      const i = t.length - 1;
      return i >= 0 && !this.box.containsPoint(swiftlet.Scene.fromNed(north[i], east[i], Math.min(0, down[i])));
    });
    if (!leaves) return;
    const before = this.box.clone();
    this.box = this.bounds();
    this.box.expandByScalar(0.2 * this.box.getSize(new THREE.Vector3()).length());
    this.box.min.y = Math.min(0, this.box.min.y);
    this.build();
    if (!before.equals(this.box) && !this.isTurned) this.home();
  }

  // A vehicle stands in the picture once it has said where it is.
  place() {
    if (this.flights.length !== this.vehicles.length) return;
    this.vehicles.forEach((vehicle, k) => { vehicle.visible = this.flights[k].path.t.length > 0; });
    super.place();
  }

  // From above, north up.
  map() {
    this.home();
    const centre = this.controls.target;
    const height = this.camera.position.distanceTo(centre);
    this.camera.position.set(centre.x, centre.y + height, centre.z + 0.001 * height);
    this.controls.update();
  }
};

swiftlet.LiveScene.mostPoints = 4000;
