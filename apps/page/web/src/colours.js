// The colours of the picture for light and for dark pages, and colour scales.

import { short } from "./text.js";

// The background, and the colours of what is drawn in one colour.
export const THEMES = {
  light: {
    background: "#f7f8fa", surface: "#828c9c", line: "#445061", edge: "#39424e", grid: "#848e9b",
    selected: "#c24e00", live: "#0b62a8", feature: "#c000c0", undefined: "#9a5fc0", second: "#2f8f83", outline: "#39424e",
  },
  dark: {
    background: "#111417", surface: "#8f99a8", line: "#aab4c0", edge: "#dfe6ee", grid: "#66707c",
    selected: "#ff9040", live: "#6ab8ee", feature: "#ff60ff", undefined: "#9a5fc0", second: "#45b5a6", outline: "#6f7884",
  },
};

// From light, near the surface, to dark, far from it.
const YELLOW_BLUE = [
  "#faf7e4", "#e6f2d2", "#c3e5c4", "#8dd3bf", "#55bcc6", "#319dc4", "#2777b4", "#25509c", "#1c2c74",
];
// Blue for negative values and red for positive ones, as light as paper at zero.
const BLUE_RED = [
  "#08306b", "#1c5aa8", "#4a8fd0", "#8fc0ea", "#cfe4f4", "#f4f1ea", "#f9d3b8", "#f0a37c", "#dd6a4e", "#b93237",
  "#7a0a22",
];

// The scales for light and for dark pages.
//
// Thin lines have the scale "sequential", whose colours have a contrast of at least 3 with the background. They are parts
// of "viridis", which has evenly rising lightness and is readable with any colour vision.
//
// Areas, which have lines of equal distance or shade, and points, which have rims, have the scales "field" and
// "signedField".
export const SCALES = {
  sequential: {
    light: ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#1f9f88"],
    dark: ["#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"],
  },
  field: { light: YELLOW_BLUE, dark: YELLOW_BLUE },
  signedField: { light: BLUE_RED, dark: BLUE_RED },
};
// The colours of bands: at the limit below a tolerance and beyond it, just below the tolerance, within, just above, and
// at the limit above and beyond it. Between the tolerance and the limit they change evenly.
export const BANDS = {
  light: ["#1d4fc0", "#0c92b0", "#3c9650", "#b38300", "#c4241f"],
  dark: ["#6f93ff", "#3cc3dd", "#4fb268", "#f0c030", "#ff6a58"],
};

// The colour of a value that is no number.
export const UNDEFINED = "#9a5fc0";

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const UNDEFINED_BYTES = rgb(UNDEFINED);

// For each byte of a colour in sRGB the linear light, which is at most 65535.
const LIGHT = Array.from({ length: 256 }, (_, byte) => {
  const x = byte / 255;
  return 65535 * (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
});

// Returns a colour as the GPU needs it: three numbers that are proportional to light and at most 65535.
export const lightOf = (hex) => rgb(hex).map((byte) => LIGHT[byte]);

// A map from values to colours between two limits. `text` returns a value as text for legends.
export class ColourScale {
  constructor(kind, low, high, text = short) {
    this.text = text;
    this.kind = kind;
    this.setTheme("light");
    this.isDiverging = kind === "signedField";
    this.low = low;
    this.high = high > low ? high : low + (Math.abs(low) || 1);
    // Whether there are values beyond the limits, which have the colours of the ends.
    this.isOpen = [false, false];
  }

  // Says that there are values from `least` to `most`.
  contain(least, most) {
    this.isOpen = [least < this.low, most > this.high];
    return this;
  }

  setTheme(theme) {
    this.stops = SCALES[this.kind][theme].map(rgb);
  }

  // Writes the three bytes of the colour of a value.
  write(value, out, at) {
    const t = (value - this.low) / (this.high - this.low);
    if (Number.isNaN(t)) {
      for (let k = 0; k < 3; k++) out[at + k] = UNDEFINED_BYTES[k];
      return;
    }
    const last = this.stops.length - 1;
    const stop = Math.max(0, Math.min(last, t * last));
    const i = Math.min(last - 1, Math.floor(stop));
    const f = stop - i;
    for (let k = 0; k < 3; k++) out[at + k] = this.stops[i][k] * (1 - f) + this.stops[i + 1][k] * f;
  }

  css(value) {
    const out = [0, 0, 0];
    this.write(value, out, 0);
    return `rgb(${out.map(Math.round).join(",")})`;
  }

  // Writes the colours of all values as the GPU needs them: three numbers each, which are proportional to light and at
  // most 65535. Each colour is written `times` times.
  writeAll(values, out, times = 1) {
    const bytes = new Uint8Array(3);
    let at = 0;
    for (const value of values) {
      this.write(value, bytes, 0);
      for (let i = 0; i < times; i++) for (let k = 0; k < 3; k++) out[at++] = LIGHT[bytes[k]];
    }
  }

  // Returns a gradient in CSS from the low limit to the high one.
  gradient() {
    const steps = Array.from({ length: 65 }, (_, i) => this.css(this.low + ((this.high - this.low) * i) / 64));
    return `linear-gradient(to right, ${steps.join(", ")})`;
  }
}

// A map from deviations to colours: one within a tolerance, others from there to a limit or to the largest deviation if
// that is less, and one beyond.
export class BandScale extends ColourScale {
  constructor(tolerance, limit, isSigned, largest) {
    super("sequential", isSigned ? -limit : 0, limit);
    Object.assign(this, { tolerance, limit, isSigned, isDiverging: isSigned, end: Math.min(limit, largest) });
  }

  setTheme(theme) {
    this.bands = BANDS[theme].map(rgb);
  }

  // Returns the colours and the ranges of the bands that values are in, the largest values first.
  ranges(values) {
    const { end, tolerance, isSigned } = this;
    const [t, l] = [tolerance, end].map(short);
    const texts = [`below -${l}`, `-${l} to -${t}`, isSigned ? `within ±${t}` : `up to ${t}`, `${t} to ${l}`, `above ${l}`];
    const used = new Set();
    for (const value of values) if (!Number.isNaN(value)) used.add(this.band(value));
    const colours = this.bands.map((band) => `rgb(${band.join(",")})`);
    const graded = { 1: [0, 1], 3: [3, 4] };
    return [4, 3, 2, 1, 0].filter((band) => used.has(band)).map((band) => [
      graded[band] ? `linear-gradient(to right, ${graded[band].map((k) => colours[k]).join(", ")})` : colours[band],
      texts[band],
    ]);
  }

  band(value) {
    const size = Math.abs(value);
    return 2 + Math.sign(value) * (size > this.tolerance ? (size > this.end ? 2 : 1) : 0);
  }

  write(value, out, at) {
    const band = Number.isNaN(value) ? null : this.band(value);
    const near = band === null ? UNDEFINED_BYTES : this.bands[band];
    const isGraded = band === 1 || band === 3;
    const part = isGraded ? (Math.abs(value) - this.tolerance) / (this.end - this.tolerance) : 0;
    const far = isGraded ? this.bands[2 * band - 2] : near;
    for (let k = 0; k < 3; k++) out[at + k] = near[k] * (1 - part) + far[k] * part;
  }
}
