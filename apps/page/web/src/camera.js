// The camera: how it fits the scene, turns, moves and flies.

import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

// The vertical angles of view in degrees. From far away the lesser one shows lines that are parallel as parallel: over
// the depth of the scene, sizes differ by less than 0.3 %. Rounding of depths would be seen with an even lesser one.
const PERSPECTIVE = 35;
const ORTHOGRAPHIC = 0.1;
// The parts of the free picture that the scene fills, and that a slice around it fills at most.
const [FILLED, FILLED_BY_SLICE] = [0.8, 0.97];
// The heights in pixels at the top and at the bottom of the picture which the toolbar and the scale bar cover.
const [COVERED_TOP, COVERED_BOTTOM] = [56, 40];
// The height that a legend covers below the toolbar, in a picture of less than this width.
const [COVERED_BY_LEGEND, NARROW] = [64, 600];
// The number of positions by which the extent of a scene in the picture is found.
const SAMPLES = 20_000;
// The distance from the middle of the scene to which the view can be moved, in radii of the scene.
const MAX_PAN = 2;
// The duration of a flight in milliseconds.
const FLIGHT = 350;
// The directions of views, with z up.
const PRESETS = {
  front: [0, -1, 0], back: [0, 1, 0], left: [-1, 0, 0], right: [1, 0, 0], top: [0, 0, 1], bottom: [0, 0, -1],
};

export class Camera {
  // `clouds` are arrays of positions which a fitted view contains, `change` is called when the view has changed.
  constructor(canvas, { radius }, up, clouds, change) {
    this.radius = radius;
    this.isYUp = up === "y";
    this.camera = new three.PerspectiveCamera(PERSPECTIVE, 1, 0.001, 100);
    this.camera.up.set(...this.fromZUp([0, 0, 1]));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => {
      this.controls.target.clampLength(0, MAX_PAN * radius);
      this.setPlanes();
      change();
    });
    this.setClouds(clouds);
    // Whether the picture has a legend.
    this.hasLegend = false;
    // Whether a fitted view is from a corner rather than from a side.
    this.isOblique = false;
    // The angle about the vertical axis by which a fitted view is turned.
    this.turned = 0;
    // The corners of a slice, which a fitted view contains as well.
    this.corners = [];
    this.setLimits();
  }

  // Returns a direction in the axes of the scene of one with z up.
  fromZUp([x, y, z]) {
    return this.isYUp ? [x, z, -y] : [x, y, z];
  }

  get isOrthographic() {
    return this.camera.fov === ORTHOGRAPHIC;
  }

  // Sets the arrays of positions which a fitted view contains.
  setClouds(clouds) {
    this.samples = sample(clouds);
  }

  // Fits the view into what is free of a picture of this size. The picture shows more than the view at the top and at the
  // bottom.
  setSize(width, height) {
    const covered = COVERED_TOP + (width < NARROW && this.hasLegend ? COVERED_BY_LEGEND : 0);
    this.height = Math.max(height / 2, height - covered - COVERED_BOTTOM, 1);
    const top = Math.min(covered, height - this.height);
    this.camera.setViewOffset(Math.max(1, width), this.height, 0, -top, Math.max(1, width), Math.max(1, height));
  }

  // Changes between the two kinds of perspective. What is in the middle keeps its size.
  setOrthographic(isOn) {
    const before = Math.tan(half(this.camera));
    this.camera.fov = isOn ? ORTHOGRAPHIC : PERSPECTIVE;
    this.setLimits();
    this.turn(0, 0, before / Math.tan(half(this.camera)));
    this.camera.updateProjectionMatrix();
  }

  setLimits() {
    const unit = this.radius / Math.tan(half(this.camera));
    [this.controls.minDistance, this.controls.maxDistance] = [0.004 * unit, 16 * unit];
  }

  // Sets the planes that bound the picture, between which everything is.
  setPlanes() {
    const { camera, controls: { target }, radius } = this;
    const distance = camera.position.distanceTo(target);
    const least = distance * 0.002;
    camera.near = Math.max(least, distance - 4 * radius);
    camera.far = distance + 5 * radius;
    camera.updateProjectionMatrix();
  }

  // Looks at the scene from a direction, or from the usual one, so that it fills the picture.
  fit(preset) {
    const direction = new three.Vector3(...(preset ? this.fromZUp(PRESETS[preset]) : this.usualDirection()));
    // A view along the vertical axis has no direction that is up.
    if (preset === "top" || preset === "bottom") direction.add(new three.Vector3(...this.fromZUp([0, -1e-4, 0])));
    const target = new three.Vector3();
    const { camera } = this;
    let distance = this.radius / Math.sin(half(camera));
    // The extent in the picture depends on the distance, which converges fast.
    for (let i = 0; i < 5; i++) {
      camera.position.copy(direction).setLength(distance).add(target);
      camera.lookAt(target);
      camera.updateMatrixWorld();
      const [middle, size] = this.extent([this.samples, this.corners], distance);
      const [own, sceneSize] = this.extent([this.samples], distance);
      // The view turns around the middle of the scene, whose depth the scale bar has, whatever else is on the page.
      target.add(middle.setZ(own.z).applyQuaternion(camera.quaternion));
      if (!(size > 0)) break;
      distance *= Math.max(1e-3, sceneSize / FILLED, size / FILLED_BY_SLICE);
    }
    this.controls.target.copy(target.clampLength(0, MAX_PAN * this.radius));
    camera.position.copy(direction).setLength(distance).add(target);
    this.controls.update();
    this.setPlanes();
  }

  // Returns the middle of positions in the view relative to the target, in the axes of the camera, and their size relative
  // to the view.
  extent(clouds, distance) {
    const { camera } = this;
    const matrix = camera.matrixWorldInverse.elements;
    const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
    const slope = [Math.tan(half(camera)) * camera.aspect, Math.tan(half(camera))];
    let [near, far] = [Infinity, -Infinity];
    for (const cloud of clouds) for (let i = 0; i < cloud.length; i += 3) {
      const [x, y, z] = [cloud[i], cloud[i + 1], cloud[i + 2]];
      const depth = -(matrix[2] * x + matrix[6] * y + matrix[10] * z + matrix[14]);
      near = Math.min(near, depth);
      far = Math.max(far, depth);
      if (!(depth > 0)) continue;
      for (let k = 0; k < 2; k++) {
        const at = (matrix[k] * x + matrix[4 + k] * y + matrix[8 + k] * z + matrix[12 + k]) / depth / slope[k];
        low[k] = Math.min(low[k], at);
        high[k] = Math.max(high[k], at);
      }
    }
    if (!(high[0] >= low[0])) return [new three.Vector3(), 0];
    const [x, y] = [0, 1].map((k) => ((low[k] + high[k]) / 2) * slope[k] * distance);
    return [new three.Vector3(x, y, distance - (near + far) / 2), Math.max(high[0] - low[0], high[1] - low[1]) / 2];
  }

  // Returns the direction from which a scene is seen at first: from a side, so that its longer side lies across the
  // picture, and a little from above; flat scenes are seen more from above.
  usualDirection() {
    const side = [0, 1, 2].map((k) => {
      let [low, high] = [Infinity, -Infinity];
      for (let i = k; i < this.samples.length; i += 3) {
        low = Math.min(low, this.samples[i]);
        high = Math.max(high, this.samples[i]);
      }
      return Math.max(0, high - low);
    });
    const [width, depth, height] = this.isYUp ? [side[0], side[2], side[1]] : side;
    const flatness = Math.max(0, 1 - (4 * height) / Math.max(width, depth, 1e-30));
    const across = width >= 0.8 * depth ? [this.isOblique ? 0.8 : 0.5, -1] : [1, this.isOblique ? -0.8 : -0.5];
    const [sine, cosine] = [Math.sin(this.turned), Math.cos(this.turned)];
    const turned = [across[0] * cosine - across[1] * sine, across[0] * sine + across[1] * cosine];
    return this.fromZUp([...turned, (this.isOblique ? 0.55 : 0.4) + 1.6 * flatness]);
  }

  // Turns fitted views about the vertical axis so that a direction lies across the picture.
  layAcross({ x, y, z }) {
    const [u, v] = this.isYUp ? [x, -z] : [x, y];
    if (Math.hypot(u, v) < Math.abs(this.isYUp ? y : z) / 4) return;
    this.turned = 0;
    const usual = this.usualDirection();
    const [a, b] = this.isYUp ? [usual[0], -usual[2]] : usual;
    // One of the two sides is nearer to the usual one.
    const side = a * v - b * u > 0 ? 1 : -1;
    this.turned = Math.atan2(side * -u, side * v) - Math.atan2(b, a);
  }

  // Returns a position at the upper right corner of what the scene covers in the picture, so many pixels away from it, and
  // half a radius nearer to the viewer than the middle of the scene.
  corner(gap) {
    const { camera, controls, radius } = this;
    camera.updateMatrixWorld();
    const at = new three.Vector3();
    let [x, y] = [-Infinity, -Infinity];
    for (let i = 0; i < this.samples.length; i += 3) {
      at.fromArray(this.samples, i).project(camera);
      [x, y] = [Math.max(x, at.x), Math.max(y, at.y)];
    }
    if (x === -Infinity) return at.copy(controls.target);
    const { fullWidth, fullHeight } = camera.view;
    // The picture is higher than what it shows of the view.
    [x, y] = [Math.min(0.85, x + (2 * gap) / fullWidth), Math.min(0.85, y + (2 * gap) / fullHeight)];
    const nearer = Math.min(radius / 2, camera.position.distanceTo(controls.target) / 2);
    const { z } = at.copy(camera.position).sub(controls.target).setLength(nearer).add(controls.target).project(camera);
    return at.set(x, y, z).unproject(camera);
  }

  // Turns the view by angles, and multiplies the distance by a factor.
  turn(around, up, factor) {
    const { camera, controls } = this;
    const offset = camera.position.clone().sub(controls.target);
    const toY = new three.Quaternion().setFromUnitVectors(camera.up, new three.Vector3(0, 1, 0));
    const spherical = new three.Spherical().setFromVector3(offset.applyQuaternion(toY));
    spherical.theta += around;
    spherical.phi = Math.max(0.01, Math.min(Math.PI - 0.01, spherical.phi + up));
    spherical.radius = Math.max(controls.minDistance, Math.min(controls.maxDistance, spherical.radius * factor));
    offset.setFromSpherical(spherical).applyQuaternion(toY.invert());
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }

  // Moves the view across itself by parts of the distance.
  pan(right, up) {
    const { camera, controls: { target } } = this;
    const distance = camera.position.distanceTo(target) * Math.tan(half(camera)) * 2.4;
    camera.updateMatrix();
    const [x, y] = [0, 1].map((k) => new three.Vector3().setFromMatrixColumn(camera.matrix, k));
    const shift = x.multiplyScalar(right * distance).addScaledVector(y, up * distance);
    const before = target.clone();
    target.add(shift).clampLength(0, MAX_PAN * this.radius);
    camera.position.add(target).sub(before);
    this.controls.update();
  }

  // Flies to a point, from which the distance is at most `part` of that of a fitted view, or jumps there if the system
  // asks for less motion. `towards` is the direction from the point to the camera, if it should change.
  flyTo(point, part, towards) {
    const { camera, controls } = this;
    const offset = camera.position.clone().sub(controls.target);
    const length = Math.min(offset.length(), (part * this.radius) / Math.sin(half(camera)));
    const [from, at] = [offset, controls.target.clone()];
    const to = (towards ?? offset).clone().setLength(length);
    const start = performance.now();
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const flight = (this.flight = (now) => {
      if (this.flight !== flight) return;
      const t = isStill ? 1 : Math.max(0, Math.min(1, (now - start) / FLIGHT));
      const eased = t * t * (3 - 2 * t);
      controls.target.lerpVectors(at, point, eased);
      const size = from.length() + (to.length() - from.length()) * eased;
      camera.position.lerpVectors(from, to, eased).setLength(size).add(controls.target);
      controls.update();
      if (t < 1) requestAnimationFrame(flight);
    });
    flight(start);
  }

  // Returns the length of a pixel in the depth of a position, or of the point that the view turns around, in the frame.
  pixelAt(position = this.controls.target) {
    const depth = -position.clone().applyMatrix4(this.camera.matrixWorldInverse).z;
    return (2 * Math.max(0, depth) * Math.tan(half(this.camera))) / this.height;
  }
}

const half = (camera) => (camera.fov / 360) * Math.PI;

// Returns some of the finite positions of arrays, with those that are farthest along the axes.
function sample(clouds) {
  const out = [];
  for (const cloud of clouds) {
    const isFinite = (i) => Number.isFinite(cloud[i] + cloud[i + 1] + cloud[i + 2]);
    const farthest = [-1, -1, -1, -1, -1, -1];
    for (let i = 0; i + 2 < cloud.length; i += 3) {
      if (!isFinite(i)) continue;
      for (let k = 0; k < 3; k++) {
        if (farthest[k] < 0 || cloud[i + k] < cloud[farthest[k] + k]) farthest[k] = i;
        if (farthest[k + 3] < 0 || cloud[i + k] > cloud[farthest[k + 3] + k]) farthest[k + 3] = i;
      }
    }
    const step = 3 * Math.max(1, Math.ceil(cloud.length / 3 / SAMPLES));
    for (let i = 0; i + 2 < cloud.length; i += step) if (isFinite(i)) farthest.push(i);
    for (const i of farthest) if (i >= 0) out.push(cloud[i], cloud[i + 1], cloud[i + 2]);
  }
  return out;
}
