// What gives the picture depth: light, smooth normals, round points, and, once the view rests, ambient occlusion.

import * as three from "three";

// The lights: a light sky over a darker ground, and a key light from above the left shoulder of the viewer.
export function addLights(world, camera) {
  const sky = new three.HemisphereLight(0xffffff, 0x8f8a84, 1.35);
  sky.position.copy(camera.up);
  const key = new three.DirectionalLight(0xffffff, 2.3);
  key.position.set(-0.7, 0.9, 1);
  camera.add(key);
  world.add(sky, camera);
}

// The cosine between the normal of a facet and that of the surface below which an edge is sharp.
const SHARP = 0.75;

// The number of triangles above which facets are flat. They are small then, and normals would take time.
const MAX_SMOOTH = 300_000;

// Returns a surface of a geometry, whose index is triangles. Facets that are almost in one plane are drawn as one smooth
// surface, and sharp edges stay sharp. With an attribute `part`, which is 0 or 1, both parts are seen where they coincide.
export function surface(geometry, parameters = {}) {
  const isSmooth = geometry.index.count <= 3 * MAX_SMOOTH;
  setNormals(geometry, geometry.index.array);
  return new three.Mesh(geometry, surfaceMaterial(isSmooth, geometry.hasAttribute("part"), parameters));
}

// Sets the normals of a geometry, unless its facets are flat.
export function setNormals(geometry, triangles) {
  if (triangles.length > 3 * MAX_SMOOTH) return;
  const normals = vertexNormals(geometry.getAttribute("position").array, triangles);
  geometry.setAttribute("normal", new three.BufferAttribute(normals, 3, true));
}

function surfaceMaterial(isSmooth, hasParts, parameters) {
  const material = new three.MeshLambertMaterial({
    side: three.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    flatShading: !isSmooth, ...parameters,
  });
  material.onBeforeCompile = (shader) => {
    if (isSmooth) smooth(shader);
    if (hasParts) check(shader);
  };
  material.customProgramCacheKey = () => `surface ${isSmooth} ${hasParts}`;
  return material;
}

function smooth(shader) {
  shader.fragmentShader = shader.fragmentShader.replace("#include <normal_fragment_begin>", `
    float faceDirection = 1.0;
    vec3 facet = normalize(cross(dFdx(vViewPosition), dFdy(vViewPosition)));
    float agreement = dot(normalize(vNormal), facet);
    vec3 normal = normalize(mix(facet, sign(agreement) * normalize(vNormal),
      smoothstep(${SHARP}, ${SHARP + 0.15}, abs(agreement))));
    vec3 nonPerturbedNormal = normal;
  `);
}

// The side of a cell of the pattern of two parts that coincide, and the distance in the frame up to which they do.
const [CELL, COINCIDENT] = ["0.06", "0.0004"];

// Lets cells in space show one of two parts in turn where both are at about one place: the other one is drawn as if it
// were farther away.
function check(shader) {
  shader.vertexShader = shader.vertexShader
    .replace("#include <common>", "#include <common>\nattribute float part;\nvarying float vPart, vFarther;\nvarying vec3 vPlace;")
    .replace("#include <project_vertex>", `#include <project_vertex>
      vec4 farther = projectionMatrix * (mvPosition - vec4(0.0, 0.0, ${COINCIDENT}, 0.0));
      vFarther = 0.5 * (farther.z / farther.w - gl_Position.z / gl_Position.w);
      vPart = part;
      vPlace = position / ${CELL} + vec3(0.237, 0.391, 0.513);`);
  shader.fragmentShader = shader.fragmentShader
    .replace("#include <common>", "#include <common>\nvarying float vPart, vFarther;\nvarying vec3 vPlace;")
    .replace("#include <opaque_fragment>", `#include <opaque_fragment>
      vec3 cell = floor(vPlace);
      gl_FragDepth = gl_FragCoord.z + (abs(mod(cell.x + cell.y + cell.z, 2.0) - vPart) < 0.5 ? vFarther : 0.0);`);
}

// Returns the normals of vertices, weighted by the areas of their triangles.
function vertexNormals(positions, triangles) {
  const sums = new Float32Array(positions.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i], 3 * triangles[i + 1], 3 * triangles[i + 2]];
    const [ux, uy, uz] = [positions[b] - positions[a], positions[b + 1] - positions[a + 1], positions[b + 2] - positions[a + 2]];
    const [vx, vy, vz] = [positions[c] - positions[a], positions[c + 1] - positions[a + 1], positions[c + 2] - positions[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const at of [a, b, c]) {
      sums[at] += x;
      sums[at + 1] += y;
      sums[at + 2] += z;
    }
  }
  const normals = new Int8Array(positions.length);
  for (let i = 0; i < sums.length; i += 3) {
    const length = Math.hypot(sums[i], sums[i + 1], sums[i + 2]) || 1;
    for (let k = i; k < i + 3; k++) normals[k] = Math.round((127 * sums[k]) / length);
  }
  return normals;
}

// What the outline of a scene is: the opacity of its lines, the angle in degrees between facets from which on an edge is
// sharp, and the number of triangles up to which sharp edges are searched, because that takes time.
const [OUTLINE, SHARP_ANGLE, MAX_EDGED] = [0.5, 35, 100_000];
// The number of ends of lines, or of points, above which an outline is fainter.
const OUTLINED = 2000;

// Returns the outline of primitives of a kind, which lies over everything: points and segments as they are, and of
// triangles the sharp edges and where a surface turns away from the viewer. The rest is not covered.
export function outline(kind, geometry) {
  // Many lines and points together must not hide the slice.
  const crowd = kind === "triangles" ? 1 : Math.min(1, OUTLINED / geometry.index.count);
  const look = { transparent: true, opacity: OUTLINE * Math.max(0.3, crowd), depthTest: false, depthWrite: false };
  if (kind === "segments") return new three.LineSegments(geometry, new three.LineBasicMaterial(look));
  if (kind === "points") return new three.Points(geometry, pointMaterial({ ...look, size: 2 }));
  const group = new three.Group();
  if (geometry.index.count <= 3 * MAX_EDGED) {
    group.add(new three.LineSegments(new three.EdgesGeometry(geometry, SHARP_ANGLE), new three.LineBasicMaterial(look)));
  }
  if (geometry.getAttribute("normal")) {
    const material = new three.MeshBasicMaterial({ ...look, side: three.DoubleSide });
    material.onBeforeCompile = (shader) => {
      shader.vertexShader = shader.vertexShader.replace("#include <common>", "#include <common>\nvarying float vFacing;")
        .replace("#include <project_vertex>", `#include <project_vertex>
          vec3 turned = normalize(normalMatrix * normal);
          vFacing = dot(turned, normalize(mvPosition.xyz));`);
      shader.fragmentShader = shader.fragmentShader.replace("#include <common>", "#include <common>\nvarying float vFacing;")
        .replace("#include <opaque_fragment>", `
          float turn = abs(vFacing) / max(1e-6, fwidth(vFacing));
          diffuseColor.a *= 1.0 - smoothstep(1.0, 2.2, turn);
          if (diffuseColor.a < 0.004) discard;
          #include <opaque_fragment>`);
    };
    material.customProgramCacheKey = () => "outline";
    group.add(new three.Mesh(geometry, material));
  }
  return group;
}

// The least and the largest size in pixels of points that have a size in the scene: of those that are lit, which form a
// surface, and of others, which would hide lines and each other.
const [LIT_SIZES, POINT_SIZES] = ["3.0, 16.0", "3.0, 6.0"];

// The opacity of what has faded, and the distances from a plane, in radii of the scene, between which things fade.
const [FADED, FADES] = ["0.12", "0.03, 0.15"];

// Lets the shader of a material fade what is away from a plane: `focus.value` has its normal, divided by the radius of
// the scene, and its distance, divided by the same. Nothing fades if all of them are 0.
export function fade(shader, focus) {
  shader.uniforms.focus = focus;
  shader.vertexShader = shader.vertexShader
    .replace("#include <common>", "#include <common>\nuniform vec4 focus;\nvarying float vFaded;")
    .replace("#include <project_vertex>", `#include <project_vertex>
      vFaded = smoothstep(${FADES}, abs(dot(focus.xyz, position) - focus.w));`);
  shader.fragmentShader = shader.fragmentShader
    .replace("#include <common>", "#include <common>\nvarying float vFaded;")
    .replace("#include <opaque_fragment>", `diffuseColor.a *= mix(1.0, ${FADED}, vFaded);\n#include <opaque_fragment>`);
}

// The part of the radius of a point that is not its rim.
const RIM = "0.7";

// Returns a material of round points. With normals of vertices they are lit as surfaces are. With `sizeAttenuation`,
// their size is that in the frame, and else it is in pixels. `marks` has the rim of points, whose value is a colour, and
// the plane away from which they fade.
export function pointMaterial(parameters, isLit = false, marks = null) {
  const material = new three.PointsMaterial({ sizeAttenuation: false, ...parameters });
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader.replace("gl_PointSize *= ( scale / - mvPosition.z );",
      `gl_PointSize = clamp(size * projectionMatrix[1][1] * scale / -mvPosition.z, ${isLit ? LIT_SIZES : POINT_SIZES});`);
    if (isLit) {
      shader.vertexShader = shader.vertexShader
        .replace("#include <common>", "#include <common>\nvarying float vLight;")
        .replace("#include <fog_vertex>", `
          vec3 facing = normalize(normalMatrix * normal + vec3(0.0, 0.0, 1e-6));
          facing = dot(facing, mvPosition.xyz) > 0.0 ? -facing : facing;
          vLight = length(normal) > 0.0
            ? 0.72 + 0.12 * facing.y + 0.36 * max(0.0, dot(facing, normalize(vec3(-0.7, 0.9, 1.0)))) : 1.0;
        `);
      shader.fragmentShader = shader.fragmentShader
        .replace("#include <common>", "#include <common>\nvarying float vLight;")
        .replace("#include <premultiplied_alpha_fragment>", "gl_FragColor.rgb *= vLight;");
    }
    shader.fragmentShader = shader.fragmentShader.replace("#include <clipping_planes_fragment>",
      "#include <clipping_planes_fragment>\nif (length(gl_PointCoord - 0.5) > 0.5) discard;");
    if (!marks) return;
    fade(shader, marks.focus);
    shader.uniforms.rim = marks.rim;
    shader.fragmentShader = shader.fragmentShader
      .replace("#include <common>", "#include <common>\nuniform vec3 rim;")
      .replace("#include <opaque_fragment>", `
        outgoingLight = mix(outgoingLight, rim, step(${RIM}, 2.0 * length(gl_PointCoord - 0.5)));
        #include <opaque_fragment>`);
  };
  material.customProgramCacheKey = () => `round ${isLit} ${!!marks}`;
  return material;
}

// The numbers of points by which the spacing of points is found, and of distances that are computed for it.
const [SPACING_SAMPLES, SPACING_DISTANCES] = [200, 4e6];

// Returns at most `most` points, evenly by their numbers, each with the next one at another place and the distance to it:
// `[point, next, distance]`. The distance of a point without a next one is infinite.
export function neighbours(positions, most = SPACING_SAMPLES) {
  const count = positions.length / 3;
  const samples = Math.min(most, count, Math.max(1, Math.floor(SPACING_DISTANCES / Math.max(1, count))));
  return Array.from({ length: samples }, (_, s) => {
    const point = Math.floor((s * count) / samples);
    const i = 3 * point;
    let [next, least] = [-1, Infinity];
    for (let j = 0; j < positions.length; j += 3) {
      const [x, y, z] = [positions[j] - positions[i], positions[j + 1] - positions[i + 1], positions[j + 2] - positions[i + 2]];
      const square = x * x + y * y + z * z;
      if (square > 0 && square < least) [next, least] = [j / 3, square];
    }
    return [point, next, Math.sqrt(least)];
  });
}

// Returns the median distance from points to the next one.
export function spacing(positions) {
  const found = neighbours(positions).map(([, , distance]) => distance).filter(Number.isFinite);
  return found.sort((a, b) => a - b)[found.length >> 1] ?? 0.01;
}

// The milliseconds for which the view rests before its picture is refined.
const REST = 120;

const OCCLUSION = `
  uniform sampler2D depths;
  uniform mat4 projection, inverse;
  uniform vec2 pixel;
  uniform float radius, strength;
  uniform vec4 plane;
  varying vec2 place;
  const int SAMPLES = 20;

  vec3 at(vec2 uv) {
    vec4 clip = vec4(vec3(uv, texture2D(depths, uv).r) * 2.0 - 1.0, 1.0);
    vec4 view = inverse * clip;
    return view.xyz / view.w;
  }

  // The shorter of two differences, so that normals do not mix surfaces at silhouettes.
  vec3 shorter(vec3 a, vec3 b) { return dot(a, a) < dot(b, b) ? a : b; }

  void main() {
    float depth = texture2D(depths, place).r;
    if (depth >= 1.0) { gl_FragColor = vec4(1.0); return; }
    vec3 here = at(place);
    // The colours of a slice are values, which shade must not change.
    if (abs(dot(plane.xyz, here) - plane.w) < radius * 0.02) { gl_FragColor = vec4(1.0); return; }
    vec3 dx = shorter(at(place + vec2(pixel.x, 0.0)) - here, here - at(place - vec2(pixel.x, 0.0)));
    vec3 dy = shorter(at(place + vec2(0.0, pixel.y)) - here, here - at(place - vec2(0.0, pixel.y)));
    vec3 normal = normalize(cross(dx, dy));
    float turn = 6.2832 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    // The radius in the picture, which depends on the depth.
    vec4 edge = projection * vec4(here + vec3(radius, 0.0, 0.0), 1.0);
    vec4 middle = projection * vec4(here, 1.0);
    float reach = clamp(abs(edge.x / edge.w - middle.x / middle.w) * 0.5, 4.0 * pixel.x, 0.2);
    float hidden = 0.0;
    for (int i = 0; i < SAMPLES; i++) {
      float part = (float(i) + 0.5) / float(SAMPLES);
      float angle = turn + float(i) * 2.399963;
      vec2 uv = place + reach * part * vec2(cos(angle), sin(angle) * pixel.y / pixel.x);
      vec3 to = at(uv) - here;
      float size = length(to);
      hidden += max(0.0, dot(normal, to) / (size + 1e-6) - 0.12) * (1.0 - smoothstep(0.7, 1.6, size / radius));
    }
    gl_FragColor = vec4(max(0.0, 1.0 - strength * hidden / float(SAMPLES)));
  }
`;

const COMPOSITION = `
  uniform sampler2D colours, shades, depths;
  uniform mat4 inverse;
  uniform vec2 pixel;
  uniform float radius;
  varying vec2 place;

  float depthAt(vec2 uv) {
    vec4 view = inverse * vec4(vec3(uv, texture2D(depths, uv).r) * 2.0 - 1.0, 1.0);
    return view.z / view.w;
  }

  void main() {
    vec4 colour = texture2D(colours, place);
    if (texture2D(depths, place).r < 1.0) {
      // The pattern of the samples has a size of four pixels, which the mean of four by four removes.
      float here = depthAt(place);
      float sum = 0.0;
      float weights = 0.0;
      for (int x = 0; x < 4; x++) {
        for (int y = 0; y < 4; y++) {
          vec2 uv = place + (vec2(float(x), float(y)) - 1.5) * pixel;
          float weight = max(1e-3, 1.0 - abs(depthAt(uv) - here) / (0.2 * radius));
          sum += weight * texture2D(shades, uv).r;
          weights += weight;
        }
      }
      colour.rgb *= sum / weights;
    }
    gl_FragColor = colour;
  }
`;

const VERTEX = "varying vec2 place; void main() { place = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";

// The milliseconds between two frames above which a moving view is drawn with fewer pixels, those below which it is not
// any more, and the part of the pixels along each side.
const [SLOW, FAST, COARSE] = [45, 12, 0.5];

// Draws the picture: at once while the view moves, and with ambient occlusion once it rests.
export class Painter {
  constructor(renderer, world, camera, radius) {
    Object.assign(this, { renderer, world, camera, radius });
    this.pixelRatio = Math.min(2, devicePixelRatio);
    this.setScale(1);
    // Whether a moving view needs fewer pixels here, and when and from where the last picture was drawn.
    this.isSlow = false;
    this.last = { time: -Infinity, view: new three.Matrix4() };
    this.isMoving = false;
    // Whether the picture has its ambient occlusion.
    this.isRefined = false;
    // How dark what is hidden from the sky becomes.
    this.strength = 1.7;
    // A plane in the frame (normal and distance) whose colours are not shaded.
    this.plane = null;
  }

  // Draws once at the next frame, however often it is called until then, and tells `drawn`.
  draw(drawn) {
    clearTimeout(this.rest);
    this.isRefined = false;
    if (this.isPending) return;
    this.isPending = true;
    requestAnimationFrame(() => {
      this.isPending = false;
      drawn();
      this.setScale(this.isViewMoving() && this.isSlow ? COARSE : 1);
      this.renderer.render(this.world, this.camera);
      this.restSoon();
    });
  }

  // Returns whether the view moves from picture to picture, and finds out whether that is slow.
  isViewMoving() {
    const { camera, last } = this;
    const now = performance.now();
    const gap = now - last.time;
    const isMoving = gap < 1000 && !last.view.equals(camera.matrixWorldInverse);
    if (isMoving && gap > SLOW) this.isSlow = true;
    if (isMoving && gap < FAST) this.isSlow = false;
    last.time = now;
    last.view.copy(camera.matrixWorldInverse);
    return isMoving;
  }

  // Sets the part of the pixels along each side that is drawn.
  setScale(scale) {
    if (this.scale === scale) return;
    this.scale = scale;
    this.renderer.setPixelRatio(this.pixelRatio * scale);
  }

  // Tells whether somebody is moving the view.
  setMoving(isMoving) {
    this.isMoving = isMoving;
    this.restSoon();
  }

  // Refines the picture after a while, unless it is drawn again before.
  restSoon() {
    clearTimeout(this.rest);
    if (!this.isMoving) this.rest = setTimeout(() => this.refine(), REST);
  }

  // Draws the picture with ambient occlusion.
  refine() {
    if (this.renderer.isAbsent || this.renderer.getContext().isContextLost()) return;
    const { renderer, world, camera } = this;
    this.setScale(1);
    const size = renderer.getDrawingBufferSize(new three.Vector2());
    if (size.x * size.y === 0) return;
    this.targets ??= makeTargets();
    const { colours, shades, occlusion, composition, quad, flat } = this.targets;
    for (const target of [colours, shades]) target.setSize(size.x, size.y);
    renderer.setRenderTarget(colours);
    // Colours are blended as on the canvas, in sRGB, so that they do not change when the view comes to rest. Three.js
    // has this for the targets of headsets only.
    colours.isXRRenderTarget = true;
    renderer.render(world, camera);
    colours.isXRRenderTarget = false;
    const uniforms = occlusion.uniforms;
    uniforms.radius.value = 0.2 * this.radius;
    uniforms.strength.value = this.strength;
    uniforms.pixel.value.set(1 / size.x, 1 / size.y);
    uniforms.projection.value.copy(camera.projectionMatrix);
    uniforms.inverse.value.copy(camera.projectionMatrixInverse);
    uniforms.plane.value.set(0, 0, 0, 1e30);
    if (this.plane) {
      const plane = this.plane.clone().applyMatrix4(camera.matrixWorldInverse);
      uniforms.plane.value.set(...plane.normal.toArray(), -plane.constant);
    }
    quad.material = occlusion;
    renderer.setRenderTarget(shades);
    renderer.render(quad, flat);
    quad.material = composition;
    renderer.setRenderTarget(null);
    renderer.render(quad, flat);
    this.isRefined = true;
  }
}

function makeTargets() {
  const colours = new three.WebGLRenderTarget(1, 1, {
    samples: 4, colorSpace: three.SRGBColorSpace, internalFormat: "RGBA8",
  });
  colours.depthTexture = new three.DepthTexture(1, 1, three.FloatType);
  const shades = new three.WebGLRenderTarget(1, 1, { depthBuffer: false });
  const shared = {
    depths: { value: colours.depthTexture }, pixel: { value: new three.Vector2() }, radius: { value: 1 }, strength: { value: 1 },
    inverse: { value: new three.Matrix4() }, projection: { value: new three.Matrix4() },
    plane: { value: new three.Vector4() }, colours: { value: colours.texture }, shades: { value: shades.texture },
  };
  const material = (fragmentShader) => new three.ShaderMaterial({
    uniforms: shared, vertexShader: VERTEX, fragmentShader, depthTest: false, depthWrite: false,
  });
  const quad = new three.Mesh(new three.PlaneGeometry(2, 2));
  quad.frustumCulled = false;
  return {
    colours, shades, occlusion: material(OCCLUSION), composition: material(COMPOSITION), quad,
    flat: new three.OrthographicCamera(),
  };
}
