// The colours of the picture for light and for dark pages, and colour scales.

import { short } from "./text.js";

// The background, and the colours of what is drawn in one colour.
export const THEMES = {
  light: {
    background: "#f7f8fa", surface: "#858e9a", line: "#4b5563",
    selected: "#c24e00", live: "#0b62a8", feature: "#c000c0",
  },
  dark: {
    background: "#111417", surface: "#7d8792", line: "#aab4c0",
    selected: "#ff9040", live: "#6ab8ee", feature: "#ff60ff",
  },
};

// The scales for light and for dark pages. All their colours have a contrast of at least 3 with the background.
// The sequential ones are parts of "viridis", which has evenly rising lightness and is readable with any colour vision.
// The diverging ones are blue for negative values and red for positive ones, with grey at zero.
export const SCALES = {
  sequential: {
    light: ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#1f9f88"],
    dark: ["#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"],
  },
  diverging: {
    light: ["#053061", "#1a559a", "#3379b8", "#6089b4", "#888888", "#bd7862", "#c2513c", "#a11f2b", "#67001f"],
    dark: ["#b3dcff", "#7cc0f5", "#4f9fdc", "#5a86ab", "#707070", "#b0735f", "#e0805f", "#ff9a70", "#ffc09f"],
  },
};

// The least limit of a half of a diverging scale, as a part of the limit of the other half.
const LEAST_HALF = 0.05;
// The colour of a value that is no number.
export const UNDEFINED = "#9a5fc0";

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const UNDEFINED_BYTES = rgb(UNDEFINED);

// For each byte of a colour in sRGB the linear light, which is at most 65535.
const LIGHT = Array.from({ length: 256 }, (_, byte) => {
  const x = byte / 255;
  return 65535 * (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
});

// A map from values to colours between two limits. `text` returns a value as text for legends.
export class ColourScale {
  constructor(kind, low, high, text = short) {
    this.text = text;
    this.kind = kind;
    this.setTheme("light");
    this.isDiverging = kind === "diverging";
    this.low = low;
    this.high = high > low ? high : low + (Math.abs(low) || 1);
  }

  setTheme(theme) {
    this.stops = SCALES[this.kind][theme].map(rgb);
  }

  // Returns the part of a diverging scale at which a value is. The middle is zero, and each half reaches to its limit,
  // or to a part of the other limit if that is farther, so that rounding has no strong colours.
  part(value) {
    const [below, above] = [-this.low, this.high];
    const limit = value < 0 ? Math.max(below, LEAST_HALF * above) : Math.max(above, LEAST_HALF * below);
    return 0.5 + 0.5 * Math.max(-1, Math.min(1, value / limit));
  }

  // Writes the three bytes of the colour of a value.
  write(value, out, at) {
    const t = this.isDiverging ? this.part(value) : (value - this.low) / (this.high - this.low);
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
