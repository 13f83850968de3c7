// What mouse, fingers and keyboard do.

import { reveal } from "./text.js";

// The keys, what they do, and the property that the viewer has in pages where they do it.
export const KEYS = [
  ["arrow keys", "turn the view"],
  ["Shift and arrow keys", "move the view"],
  ["+ and -", "come nearer and go farther"],
  ["f", "fit the view to the scene"],
  ["1 to 6", "view from front, back, left, right, top, bottom"],
  ["o, e and g", "parallel view, edges, grid"],
  ["s", "save a picture"],
  ["n and p", "next and previous answer", "answers"],
  ["n and p", "next and previous point", "deviations"],
  ["x, y and z", "lay the slice across this axis", "slice"],
  ["[ and ]", "move the slice", "slice"],
  ["v", "read the slice in the middle of the picture", "slice"],
  ["l and k", "next and previous level of boxes", "cells"],
  ["q", "let the live query follow the mouse, or stop", "live"],
  ["d", "dark or light"],
  ["?", "show or hide this list"],
];

// Lets the picture follow the pointer, and the page the keyboard.
export function listen(viewer) {
  const { canvas } = viewer;
  let pressed = null;
  let isDragging = false;
  const release = () => {
    pressed = null;
    isDragging = false;
    viewer.controls.enabled = true;
  };
  canvas.addEventListener("pointerdown", (event) => {
    pressed = [event.clientX, event.clientY];
    isDragging = event.shiftKey && !!viewer.slice;
    viewer.controls.enabled = !isDragging;
    viewer.overlay.showTip(event, "");
    if (isDragging) canvas.setPointerCapture(event.pointerId);
  }, { capture: true });
  canvas.addEventListener("pointermove", (event) => {
    if (isDragging) {
      viewer.slicePanel.move(viewer.slice.axis, viewer.slicePart - event.movementY / canvas.clientHeight);
    }
    viewer.live?.follow(event);
    if (event.buttons === 0) viewer.point(event);
  });
  canvas.addEventListener("pointerleave", (event) => viewer.overlay.showTip(event, ""));
  canvas.addEventListener("pointerup", (event) => {
    const isClick = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 4;
    release();
    // A finger has no position before it touches.
    if (isClick && event.pointerType === "touch") {
      viewer.live?.follow(event);
      viewer.point(event);
    }
    const picked = isClick && viewer.answers ? viewer.pick(event) : -1;
    if (isClick && viewer.answers) viewer.answersPanel.select(picked);
    if (isClick && picked < 0) {
      viewer.slicePanel?.keep(event);
      viewer.live?.keep(event);
    }
    if (isClick && viewer.deviationsPanel) viewer.deviationsPanel.select(viewer.deviationsPanel.pick(event));
  });
  canvas.addEventListener("pointercancel", release);
  document.addEventListener("keydown", (event) => press(viewer, event));
}

// Returns whether an element uses keys itself, so that they do nothing to the picture.
function takesKeys(target, key) {
  if (target.matches?.("input:not([type=checkbox]), select, textarea, [contenteditable]")) return true;
  return key.startsWith("Arrow") && target !== document.body && target.id !== "picture";
}

function press(viewer, event) {
  // Some keyboards have the brackets on keys that need AltGr, which counts as Ctrl and Alt.
  const isBracket = event.key === "[" || event.key === "]";
  if (!isBracket && (event.ctrlKey || event.metaKey || event.altKey)) return;
  if (event.defaultPrevented || takesKeys(event.target, event.key)) return;
  const { slicePanel, cellsPanel, answersPanel, deviationsPanel } = viewer;
  const list = answersPanel ?? deviationsPanel;
  const click = (id) => () => document.getElementById(id)?.click();
  const actions = {
    ShiftArrowLeft: () => viewer.pan(-0.05, 0), ShiftArrowRight: () => viewer.pan(0.05, 0),
    ShiftArrowUp: () => viewer.pan(0, 0.05), ShiftArrowDown: () => viewer.pan(0, -0.05),
    ArrowLeft: () => viewer.turn(-0.1, 0, 1), ArrowRight: () => viewer.turn(0.1, 0, 1),
    ArrowUp: () => viewer.turn(0, -0.1, 1), ArrowDown: () => viewer.turn(0, 0.1, 1),
    "+": () => viewer.turn(0, 0, 0.9), "=": () => viewer.turn(0, 0, 0.9), "-": () => viewer.turn(0, 0, 1 / 0.9),
    f: () => viewer.fit(), d: () => viewer.toggleTheme(),
    1: () => viewer.fit("front"), 2: () => viewer.fit("back"), 3: () => viewer.fit("left"),
    4: () => viewer.fit("right"), 5: () => viewer.fit("top"), 6: () => viewer.fit("bottom"),
    o: click("orthographic"), e: click("edges"), g: click("grid"), s: click("picture-file"),
    q: viewer.live && (() => viewer.live.setFollowing(!viewer.live.isFollowing)),
    n: list && (() => list.step(1)), p: list && (() => list.step(-1)),
    x: slicePanel && (() => slicePanel.turn(0)), y: slicePanel && (() => slicePanel.turn(1)),
    z: slicePanel && (() => slicePanel.turn(2)),
    "[": slicePanel && (() => slicePanel.shift(-0.02)), "]": slicePanel && (() => slicePanel.shift(0.02)),
    v: slicePanel && (() => {
      slicePanel.read(null);
      reveal(slicePanel.value);
    }),
    l: cellsPanel && (() => cellsPanel.step(1)), k: cellsPanel && (() => cellsPanel.step(-1)),
    "?": () => viewer.showHelp(),
  };
  const isShifted = event.shiftKey && event.key.startsWith("Arrow");
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const action = actions[isShifted ? `Shift${key}` : key];
  if (!action) return;
  event.preventDefault();
  action();
}
