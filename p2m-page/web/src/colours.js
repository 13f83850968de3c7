// Colour scales, and their legends.

import { short } from "./text.js";

// Points of the scale "viridis", which has evenly rising lightness and is readable with any colour vision.
const SEQUENTIAL = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"];
// Blue for negative values and red for positive ones, with grey at zero.
const DIVERGING = ["#053061", "#2166ac", "#4393c3", "#92c5de", "#d9d9d9", "#f4a582", "#d6604d", "#b2182b", "#67001f"];

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const STOPS = { sequential: SEQUENTIAL.map(rgb), diverging: DIVERGING.map(rgb) };

// The light of each byte of a colour in sRGB.
const LIGHT = Array.from({ length: 256 }, (_, byte) => {
  const x = byte / 255;
  return 65535 * (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
});

// A map from values to colours between two limits. `text` returns a value as text for legends.
export class ColourScale {
  constructor(kind, low, high, text = short) {
    this.text = text;
    this.stops = STOPS[kind];
    this.isDiverging = kind === "diverging";
    this.low = low;
    this.high = high > low ? high : low + (Math.abs(low) || 1);
  }

  // Writes the three bytes of the colour of a value. The middle of a diverging scale is zero. A value that is no number
  // is grey.
  write(value, out, at) {
    let t = (value - this.low) / (this.high - this.low);
    if (this.isDiverging) t = 0.5 + 0.5 * Math.max(-1, Math.min(1, value / Math.max(-this.low, this.high)));
    if (Number.isNaN(t)) {
      out[at] = out[at + 1] = out[at + 2] = 128;
      return;
    }
    const last = this.stops.length - 1;
    const place = Math.max(0, Math.min(last, t * last));
    const i = Math.min(last - 1, Math.floor(place));
    const f = place - i;
    for (let k = 0; k < 3; k++) out[at + k] = this.stops[i][k] * (1 - f) + this.stops[i + 1][k] * f;
  }

  css(value) {
    const out = [0, 0, 0];
    this.write(value, out, 0);
    return `rgb(${out.map(Math.round).join(",")})`;
  }

  // Returns the colours of all values as the GPU needs them: three numbers each, which are proportional to light and at
  // most 65535.
  colours(values) {
    const bytes = new Uint8Array(3);
    const out = new Uint16Array(3 * values.length);
    for (let i = 0; i < values.length; i++) {
      this.write(values[i], bytes, 0);
      for (let k = 0; k < 3; k++) out[3 * i + k] = LIGHT[bytes[k]];
    }
    return out;
  }

  // Returns a gradient in CSS from the low limit to the high one.
  gradient() {
    const steps = Array.from({ length: 17 }, (_, i) => this.css(this.low + ((this.high - this.low) * i) / 16));
    return `linear-gradient(to right, ${steps.join(", ")})`;
  }
}
