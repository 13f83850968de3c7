// Scenes for tests, and random numbers with fixed seeds.

/** Returns a generator of numbers from `low` to `high` (mulberry32). */
export function generator(seed: number): (low?: number, high?: number) => number {
  return (low = 0, high = 1) => {
    seed = (seed + 0x6d2b79f5) | 0;
    let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    // The numbers use all digits of double precision.
    return low + (high - low) * (((t ^ (t >>> 14)) >>> 0) / 2 ** 32 + ((t >>> 3) & 0xfffff) / 2 ** 52);
  };
}

export interface Arrays {
  positions: Float64Array;
  triangles: Uint32Array;
  segments: Uint32Array;
  points: Uint32Array;
}

/** Returns a closed surface: a sphere with waves. Its centre may be far from the origin. */
export function blob(rings: number, centre = [0, 0, 0], scale = 1): Arrays {
  const [positions, triangles]: [number[], number[]] = [[], []];
  const at = (i: number, j: number) => i * rings * 2 + (j % (rings * 2));
  for (let i = 0; i <= rings; i++) {
    for (let j = 0; j < rings * 2; j++) {
      const [u, v] = [(Math.PI * i) / rings, (Math.PI * j) / rings];
      const r = scale * (1 + 0.2 * Math.sin(3 * u) * Math.cos(5 * v) * Math.sin(u));
      positions.push(centre[0]! + r * Math.sin(u) * Math.cos(v), centre[1]! + r * Math.sin(u) * Math.sin(v),
        centre[2]! + r * Math.cos(u));
      if (i === rings) continue;
      triangles.push(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return arrays(positions, triangles);
}

/** Returns random primitives of all kinds, some of them degenerate. */
export function mixture(triangles: number, segments: number, points: number, seed: number): Arrays {
  const random = generator(seed);
  const positions = Array.from({ length: 3000 }, (_, i) => (i % 30 === 0 ? Math.floor(random(-3, 4)) : random(-3, 3)));
  const vertices = (count: number) => Array.from({ length: count }, () => Math.floor(random(0, 1000)));
  const near = (count: number) => vertices(count).flatMap((i) => [i, (i + 1) % 1000, (i + (i % 7)) % 1000]);
  return arrays(positions, near(triangles), vertices(2 * segments), vertices(points));
}

function arrays(positions: number[], triangles: number[], segments: number[] = [], points: number[] = []): Arrays {
  return {
    positions: Float64Array.from(positions), triangles: Uint32Array.from(triangles),
    segments: Uint32Array.from(segments), points: Uint32Array.from(points),
  };
}

/** Returns points in a box around a scene. */
export function pointsAround({ positions }: Arrays, count: number, seed: number, scale = 2): Float64Array {
  const random = generator(seed);
  const bounds = [0, 1, 2].map((k) => {
    const own = positions.filter((_, i) => i % 3 === k);
    const [low, high] = [own.reduce((a, b) => Math.min(a, b)), own.reduce((a, b) => Math.max(a, b))];
    return [(low + high) / 2, ((high - low) / 2) * scale] as const;
  });
  return Float64Array.from({ length: 3 * count }, (_, i) => {
    const [middle, half] = bounds[i % 3]!;
    return middle + random(-half, half);
  });
}

/** Returns the arrays rounded to single precision. */
export function rounded(scene: Arrays): Arrays {
  return { ...scene, positions: Float64Array.from(scene.positions, Math.fround) };
}

/** Returns the scene as an OBJ file, whose primitives have the same ids as in `Scene`. */
export function obj({ positions, triangles, segments, points }: Arrays): string {
  const rows = (key: string, array: ArrayLike<number>, width: number, add: number) =>
    Array.from({ length: array.length / width }, (_, i) =>
      `${key} ${Array.from({ length: width }, (_, k) => array[width * i + k]! + add).join(" ")}\n`).join("");
  return rows("v", positions, 3, 0) + rows("f", triangles, 3, 1) + rows("l", segments, 2, 1) + rows("p", points, 1, 1);
}

/** Parses an OBJ file whose faces are triangles and whose lines have two vertices. */
export function parseObj(text: string): Arrays {
  const kinds: Record<string, number[]> = { v: [], f: [], l: [], p: [] };
  for (const line of text.split("\n")) {
    const [key = "", ...words] = line.trim().split(/\s+/);
    kinds[key]?.push(...words.map((word) => (key === "v" ? Number(word) : parseInt(word, 10) - 1)));
  }
  return arrays(kinds["v"]!, kinds["f"]!, kinds["l"]!, kinds["p"]!);
}
