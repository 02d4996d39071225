// Paths and vehicles in space, drawn by three.js. Its axes: x east, y up, z south.
'use strict';

swiftlet.Scene = class {
  // flights: [{name, colour, path: {t, north, east, down, q: [w, x, y, z]}, reference, fence}], columns of numbers.
  constructor(parent, flights, axis) {
    this.flights = flights;
    this.axis = axis;
    this.canvas = swiftlet.element('canvas', {role: 'img', 'aria-label': this.description()});
    parent.append(this.canvas);
    try {
      this.renderer = new THREE.WebGLRenderer({canvas: this.canvas, antialias: true, alpha: true});
    } catch (error) {
      this.canvas.replaceWith(swiftlet.element('p', {class: 'quiet'}, 'This browser draws no 3-D pictures (WebGL).'));
      return;
    }
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1e4);
    this.box = this.bounds();
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.plan());
    // The wheel alone scrolls the page.
    parent.addEventListener('wheel', (event) => event.ctrlKey || event.stopPropagation(), true);
    this.build();
    this.home();
    axis.on('cursor', () => this.place());
    swiftlet.theme.onChange(() => {
      this.build();
      this.place();
    });
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.place();
  }

  description() {
    const extent = (values) => {
      const [least, most] = swiftlet.extent(values);
      return `${swiftlet.number(least)} to ${swiftlet.number(most)} m`;
    };
    return 'Paths in space. ' + this.flights.map(({name, path}) =>
      `${name}: north ${extent(path.north)}, east ${extent(path.east)}, down ${extent(path.down)}`).join('; ');
  }

  static fromNed(north, east, down) {
    return new THREE.Vector3(east, -down, -north);
  }

  bounds() {
    const box = new THREE.Box3();
    for (const {path} of this.flights) {
      const [north, east, down] = [path.north, path.east, path.down].map(swiftlet.extent);
      box.expandByPoint(swiftlet.Scene.fromNed(north[0], east[0], down[0]));
      box.expandByPoint(swiftlet.Scene.fromNed(north[1], east[1], down[1]));
    }
    return box;
  }

  build() {
    this.scene = new THREE.Scene();
    const size = this.box.getSize(new THREE.Vector3());
    this.extent = Math.max(size.x, size.y, size.z, 0.5);
    const centre = this.box.getCenter(new THREE.Vector3());
    const cell = 10 ** Math.floor(Math.log10(this.extent)) / (this.extent / 10 ** Math.floor(Math.log10(this.extent)) < 3 ? 4 : 1);
    const cells = Math.ceil(1.6 * this.extent / cell / 2) * 2;
    const grid = new THREE.GridHelper(cells * cell, cells, swiftlet.theme.colour('axis'), swiftlet.theme.colour('grid'));
    grid.position.set(Math.round(centre.x / cell) * cell, 0, Math.round(centre.z / cell) * cell);
    this.scene.add(grid, new THREE.HemisphereLight(0xffffff, 0x666666, 1.1));
    const edge = cells * cell / 2;
    this.scene.add(this.label('N', grid.position.x, 0, grid.position.z - edge),
                   this.label('E', grid.position.x + edge, 0, grid.position.z));
    this.gridText = `grid ${swiftlet.number(cell)} m`;
    this.vehicles = this.flights.map((flight) => this.addFlight(flight));
  }

  addFlight({colour, path, reference, fence}) {
    const main = swiftlet.theme.series(colour);
    if (fence) this.scene.add(this.fence(fence));
    this.scene.add(this.line(path, main));
    if (reference) this.scene.add(this.line(reference, swiftlet.theme.colour('muted')));
    const vehicle = this.vehicle(main);
    this.scene.add(vehicle);
    return vehicle;
  }

  line({t, north, east, down}, colour) {
    const step = Math.ceil(t.length / 20000);
    const points = [];
    for (let i = 0; i < t.length; i += step) {
      if (!Number.isNaN(north[i])) points.push(swiftlet.Scene.fromNed(north[i], east[i], down[i]));
    }
    return new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineBasicMaterial({color: colour}));
  }

  fence({min, max}) {
    const box = new THREE.Box3().setFromPoints([swiftlet.Scene.fromNed(...min), swiftlet.Scene.fromNed(...max)]);
    return new THREE.Box3Helper(box, swiftlet.theme.colour('limit'));
  }

  // Arms and rotors, the front ones in the limits' colour; drawn larger than it is if the path is long.
  vehicle(colour) {
    const group = new THREE.Group();
    const size = Math.max(0.12, 0.07 * this.extent);
    const material = (name) => new THREE.MeshLambertMaterial({color: name});
    const add = (geometry, look, x, y, z, turn = 0) => {
      const mesh = new THREE.Mesh(geometry, look);
      mesh.position.set(x, y, z);
      mesh.rotation.y = turn;
      group.add(mesh);
    };
    const body = material(colour);
    add(new THREE.BoxBufferGeometry(0.3 * size, 0.12 * size, 0.3 * size), body, 0, 0, 0);
    for (const turn of [Math.PI / 4, -Math.PI / 4])
      add(new THREE.BoxBufferGeometry(1.1 * size, 0.05 * size, 0.06 * size), body, 0, 0, 0, turn);
    const disc = new THREE.CylinderBufferGeometry(0.24 * size, 0.24 * size, 0.03 * size, 24);
    const front = material(swiftlet.theme.colour('limit'));
    for (const x of [-1, 1]) {
      for (const z of [-1, 1]) add(disc, z < 0 ? front : body, 0.39 * size * x, 0.06 * size, 0.39 * size * z);
    }
    return group;
  }

  label(text, x, y, z) {
    const picture = swiftlet.element('canvas', {width: 64, height: 64});
    const context = picture.getContext('2d');
    context.font = 'bold 44px sans-serif';
    context.textAlign = 'center';
    context.fillStyle = swiftlet.theme.colour('muted');
    context.fillText(text, 32, 48);
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({map: new THREE.CanvasTexture(picture), transparent: true}));
    sprite.position.set(x, y, z);
    sprite.scale.setScalar(0.1 * this.extent);
    return sprite;
  }

  // From the south-west above, with all in sight.
  home() {
    const centre = this.box.getCenter(new THREE.Vector3());
    const radius = this.box.getSize(new THREE.Vector3()).length() / 2 + 0.3;
    const direction = new THREE.Vector3(-0.45, 0.5, 0.9).normalize();
    this.camera.position.copy(centre).addScaledVector(direction, 2.9 * radius);
    this.controls.target.copy(centre);
    this.controls.update();
  }

  // Puts the vehicles where they are at the cursor.
  place() {
    this.flights.forEach(({path}, k) => {
      if (!path.t.length) return;
      const i = Math.max(0, swiftlet.columns.indexAt(path.t, this.axis.cursor));
      const [w, x, y, z] = path.q.map((column) => column[i]);
      this.vehicles[k].position.copy(swiftlet.Scene.fromNed(path.north[i], path.east[i], path.down[i]));
      this.vehicles[k].quaternion.set(y, -z, -x, w).normalize();
    });
    this.plan();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.plan();
  }

  plan() {
    if (this.planned) return;
    this.planned = true;
    requestAnimationFrame(() => {
      this.planned = false;
      this.renderer.render(this.scene, this.camera);
    });
  }
};
