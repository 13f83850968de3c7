// Query points, their closest points, and the answer that is selected.

import * as three from "three";
import { ColourScale } from "./colours.js";
import { fade, pointMaterial } from "./shading.js";
import { distanceParts, element, number, sideOf } from "./text.js";

// The opacity of segments to closest points.
const QUIET = 0.4;
// The sizes in pixels of query points and of closest points, up to so many answers.
const SIZES = [[500, 5, 3], [20_000, 4, 2.5], [Infinity, 3, 2]];

export class AnswersLayer {
  constructor(answers, frame) {
    Object.assign(this, answers);
    this.frame = frame;
    this.length = answers.distances.length;
    // The values that give colours: signed distances where there are some.
    this.values = answers.signed ?? answers.distances;
    this.scale = distanceScale(this.values);
    this.from = frame.positions(answers.queries);
    this.to = frame.positions(answers.points);
    this.answeredCount = 0;
    for (let i = 0; i < this.length; i++) {
      if (this.isAnswered(i)) this.answeredCount++;
      // Without an answer, the closest point and the segment are drawn where the query is.
      else this.to.set(this.from.subarray(3 * i, 3 * i + 3), 3 * i);
    }
    // The plane near which answers are seen best, and the rims of points.
    this.focus = { value: new three.Vector4() };
    this.rim = { value: new three.Color() };
    const [, size, footSize] = SIZES.find(([most]) => this.length <= most);
    this.dots = this.makeDots(this.from, size);
    this.feet = this.makeDots(this.to, footSize);
    const ends = new Float32Array(6 * this.length);
    for (let i = 0; i < this.length; i++) {
      for (const [end, from] of [[0, this.from], [3, this.to]]) ends.set(from.subarray(3 * i, 3 * i + 3), 6 * i + end);
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(ends, 3));
    // Segments are quiet, so that they do not hide the scene. The selected one is drawn once more.
    const quiet = new three.LineBasicMaterial({ transparent: true, opacity: QUIET, depthWrite: false });
    quiet.onBeforeCompile = (shader) => fade(shader, this.focus);
    this.segments = new three.LineSegments(geometry, quiet);
    this.group = new three.Group();
    this.group.add(this.dots, this.feet, this.segments);
    this.selection = new three.Group();
    // The answer under the pointer, whose segment is drawn once more.
    this.pointed = -1;
    this.highlight = new three.Group();
    this.group.add(this.highlight);
    this.selected = -1;
    this.hasSphere = this.hasSelectedSphere = true;
  }

  setTheme(theme, colours) {
    this.scale.setTheme(theme);
    this.select(this.selected, colours);
    this.rim.value.set(colours.edge);
    this.segments.material.color.set(colours.line);
    for (const { geometry } of [this.dots, this.feet]) {
      const attribute = geometry.getAttribute("color");
      this.scale.writeAll(this.values, attribute.array);
      attribute.needsUpdate = true;
    }
  }

  // Lets answers fade that are away from a plane, or none.
  fadeAwayFrom(plane, radius) {
    this.focus.value.set(0, 0, 0, 0);
    if (plane) this.focus.value.set(...plane.normal.toArray(), -plane.constant).divideScalar(radius);
  }

  // Makes round dots of a size in pixels, which have rims.
  makeDots(positions, size) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(positions, 3));
    geometry.setAttribute("color", new three.BufferAttribute(new Uint16Array(positions.length), 3, true));
    return new three.Points(geometry, pointMaterial({ size, vertexColors: true, transparent: true }, false, this));
  }

  isAnswered(i) {
    return !Number.isNaN(this.distances[i]);
  }

  // Selects an answer, and draws its primitive, its feature, its segment and, if there should be one, the sphere of its
  // lower bound.
  select(i, colours, withSphere = this.hasSelectedSphere) {
    this.selected = i;
    this.hasSelectedSphere = withSphere;
    empty(this.highlight);
    empty(this.selection);
    if (i < 0) return;
    const at = (array, k) => new three.Vector3(...array.subarray(3 * k, 3 * k + 3));
    const query = at(this.from, i);
    if (!this.isAnswered(i)) {
      this.selection.add(marker(query, colours.selected, 9));
      return;
    }
    const vertices = [0, 1, 2].slice(0, this.sizes[i]).map((k) => at(this.vertices, 3 * i + k));
    const radius = this.hasSphere && withSphere ? this.lower_bounds[i] / this.frame.scale : 0;
    drawAnswer(this.selection, query, at(this.to, i), vertices, featureOf(this.features[i]), radius, colours);
  }

  // Draws the segment of the answer under the pointer once more, or of none.
  point(i, colours) {
    this.pointed = i;
    empty(this.highlight);
    if (i < 0 || !this.isAnswered(i) || i === this.selected) return;
    const [query, foot] = [this.from, this.to].map((ends) => new three.Vector3(...ends.subarray(3 * i, 3 * i + 3)));
    this.highlight.add(line([query, foot], colours.selected), marker(query, colours.selected, 9));
  }

  // Returns the terms and texts of an answer.
  rows(i, viewer) {
    return answerRows(viewer, {
      point: this.points.subarray(3 * i, 3 * i + 3), distance: this.distances[i], signed: this.signed?.[i],
      lowerBound: this.lower_bounds[i], size: this.sizes[i], primitive: this.primitives[i], feature: this.features[i],
    });
  }

  featureName(i) {
    return featureName(this.features[i]);
  }

  // Returns the answer whose query or closest point is the nearest to a position on the screen, if one is within
  // `radius` pixels.
  pick(camera, size, x, y, radius) {
    const ends = [[this.dots, this.from], [this.feet, this.to]].filter(([dots]) => dots.visible);
    const projected = new three.Vector3();
    let [found, best] = [-1, radius * radius];
    for (let i = 0; i < this.length; i++) {
      for (const [, array] of ends) {
        projected.fromArray(array, 3 * i).project(camera);
        if (Math.abs(projected.z) > 1) continue;
        const [dx, dy] = [((projected.x + 1) / 2) * size.x - x, ((1 - projected.y) / 2) * size.y - y];
        const square = dx * dx + dy * dy;
        if (square < best) [found, best] = [i, square];
      }
    }
    return found;
  }
}

// Returns the kind of the feature with a code, and its number within the primitive.
export function featureOf(code) {
  return code === 6 ? ["face", 0] : code < 3 ? ["vertex", code] : ["edge", code - 3];
}

// Returns the terms and texts of an answer for a list. `size` is the number of vertices of the primitive, and `signed`
// the signed distance if there is one.
export function answerRows(viewer, { point, distance, signed, lowerBound, size, primitive, feature }) {
  return [
    ["distance", distanceOf(distance, signed, viewer.unit)],
    ...(viewer.data.no_inside ? [["inside", noInside(viewer)]] : []),
    ...(signed === undefined ? [] : [["signed distance", signed]]),
    ["closest point", viewer.place(point)],
    ["lower bound", lowerBound],
    ["primitive", `${KINDS[size]} ${primitive}`],
    ["feature", featureName(feature)],
  ];
}

// Returns a sentence on why there is no inside.
export const noInside = ({ data: { no_inside: others } }) => `No inside here, because the scene holds ${others}.`;

// Makes an entry that explains the words of an answer.
export const explainedWords = () => element("details", {}, element("summary", {}, "What the words mean"), element("dl", {},
  ...[
    ["lower bound", "A length that the true distance is certain not to fall below, in spite of rounding."],
    ["primitive", "The triangle, segment or point of the scene that holds the closest point, and its number."],
    ["feature", "The part of that primitive which holds it: its face, an edge or a vertex."],
  ].flatMap(([word, meaning]) => [element("dt", {}, word), element("dd", {}, meaning)])));

// Makes an element that says a distance in words, with the side of the surface if there is a signed distance.
function distanceOf(distance, signed, unit) {
  const isSigned = sideOf(signed) !== undefined;
  return element("span", {}, ...distanceParts(isSigned ? signed : distance, isSigned, unit, number));
}

export function featureName(code) {
  const [kind, number] = featureOf(code);
  return kind === "face" ? kind : `${kind}${number}`;
}

// Removes everything from a group, and frees its memory on the GPU.
export function empty(group) {
  for (const { geometry, material } of group.children) {
    geometry.dispose();
    material.dispose();
  }
  group.clear();
}

// Adds an answer to a group: the query, the segment to its closest point, the primitive with these vertices, its
// feature and the sphere of the lower bound.
export function drawAnswer(group, query, foot, vertices, feature, radius, colours) {
  const { selected } = colours;
  group.add(marker(query, selected, 9), marker(foot, selected, 7), line([query, foot], selected));
  const size = vertices.length;
  if (size === 3) {
    const face = new three.BufferGeometry().setFromPoints(vertices);
    const material = new three.MeshBasicMaterial({
      color: colours.selected, side: three.DoubleSide, transparent: true, opacity: 0.35, depthTest: false,
    });
    const drawn = new three.Mesh(face, material);
    drawn.renderOrder = 2;
    group.add(drawn);
  }
  if (size > 1) group.add(line([...vertices, vertices[0]].slice(0, size === 3 ? 4 : 2), colours.selected));
  // The feature that holds the closest point is drawn once more, over everything else.
  const [kind, number] = size > 0 ? feature : ["none", 0];
  if (kind === "vertex") group.add(marker(vertices[number], colours.feature, 10));
  if (kind === "edge") group.add(line([vertices[number], vertices[(number + 1) % size]], colours.feature));
  if (radius > 0) {
    const sphere = new three.Mesh(
      new three.SphereGeometry(1, 32, 20),
      new three.MeshBasicMaterial({ color: colours.selected, transparent: true, opacity: 0.14, depthWrite: false }),
    );
    sphere.scale.setScalar(radius);
    sphere.position.copy(query);
    group.add(sphere);
  }
}

// The kinds of primitives, by their numbers of vertices.
export const KINDS = ["", "point", "segment", "triangle"];

// Returns the scale of distances. If some of them are negative, it is symmetric about zero. It reaches to the largest
// distance, unless those of the other sign are much smaller and would have hardly a colour.
export function distanceScale(values) {
  const [low, high] = limits(values);
  if (!(low < 0)) return new ColourScale("field", 0, high);
  const [shorter, longer] = [Math.min(-low, high), Math.max(-low, high)];
  const limit = high > 0 ? Math.min(longer, Math.max(4 * shorter, 0.6 * longer)) : longer;
  return new ColourScale("signedField", -limit, limit).contain(low, high);
}

// Returns the smallest and the largest number among values, of which some may be no numbers.
export function limits(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [0, 1];
}

export function marker(position, color, size) {
  const geometry = new three.BufferGeometry().setFromPoints([position]);
  const material = pointMaterial({ color, size, depthTest: false, transparent: true });
  const drawn = new three.Points(geometry, material);
  drawn.renderOrder = 3;
  return drawn;
}

export function line(vertices, color) {
  const geometry = new three.BufferGeometry().setFromPoints(vertices);
  const drawn = new three.Line(geometry, new three.LineBasicMaterial({ color, depthTest: false, transparent: true }));
  drawn.renderOrder = 3;
  return drawn;
}
