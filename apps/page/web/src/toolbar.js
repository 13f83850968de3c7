// The toolbar over the picture.

import { element } from "./text.js";

const ICONS = {
  fit: "M3 7V3h4M13 3h4v4M17 13v4h-4M7 17H3v-4M8 8h4v4H8z",
  orthographic: "M10 2.5l6.5 3.7v7.6L10 17.5l-6.5-3.7V6.2zM3.5 6.2L10 10l6.5-3.8M10 10v7.5",
  edges: "M2.5 16.5L10 3.5l7.5 13zM6.2 10h7.6M10 16.5L13.8 10M10 16.5L6.2 10",
  grid: "M3 3h14v14H3zM3 7.7h14M3 12.3h14M7.7 3v14M12.3 3v14",
  "picture-file": "M3 6h3l1.5-2h5L14 6h3v10H3zM10 13.7a2.9 2.9 0 1 0 0-5.8 2.9 2.9 0 0 0 0 5.8z",
  full: "M12 3h5v5M17 3l-6 6M8 17H3v-5M3 17l6-6",
  theme: "M10 3a7 7 0 1 0 0 14zM10 3a7 7 0 0 1 0 14M10 3v14",
  help: "M7.4 7.6a2.6 2.6 0 1 1 3.9 2.3c-.9.5-1.3 1-1.3 2M10 15v.6",
};
const VIEWS = ["front", "back", "left", "right", "top", "bottom"];

// Makes the toolbar of a viewer and puts it over the picture.
export function addToolbar(viewer, stage) {
  const icon = (id) => element("svg", { viewBox: "0 0 20 20", "aria-hidden": "true" }, element("path", { d: ICONS[id] }));
  const button = (id, label, onclick) =>
    element("button", { type: "button", id, title: label, "aria-label": label, onclick }, icon(id));
  const toggle = (id, label, change) => {
    const made = button(id, label, () => {
      const isOn = made.getAttribute("aria-pressed") !== "true";
      made.setAttribute("aria-pressed", String(isOn));
      change(isOn);
      viewer.draw();
    });
    made.setAttribute("aria-pressed", "false");
    return made;
  };
  const views = element("select", { id: "views", "aria-label": "View from", title: "View from", onchange: () => {
    if (views.value) viewer.fit(views.value);
    views.value = "";
  } }, element("option", { value: "" }, "View"), ...VIEWS.map((view) => element("option", { value: view }, view)));
  const hasTriangles = viewer.data.scene.triangles.length > 0;
  const parts = [
    button("fit", "Fit the view (f)", () => viewer.fit()), views,
    toggle("orthographic", "Parallel lines stay parallel (o)", (isOn) => viewer.view.setOrthographic(isOn)),
    hasTriangles && toggle("edges", "Edges of triangles (e)", (isOn) => viewer.scene.setEdges(isOn, viewer.colours)),
    toggle("grid", "Grid (g)", (isOn) => viewer.overlay.setGrid(isOn)),
    button("picture-file", "Save a picture (s)", () => savePicture(viewer)),
    document.fullscreenEnabled && button("full", "Full screen", () => changeFullScreen()),
    button("theme", "Dark or light (d)", () => viewer.toggleTheme()),
    button("help", "Mouse and keyboard (?)", () => viewer.showHelp()),
  ];
  stage.append(element("div", { id: "toolbar", role: "toolbar", "aria-label": "View" }, ...parts.filter(Boolean)));
}

function changeFullScreen() {
  if (document.fullscreenElement) document.exitFullscreen();
  else document.documentElement.requestFullscreen();
}

// Saves the picture without the panel as a PNG file.
function savePicture(viewer) {
  viewer.painter.refine();
  const link = element("a", { href: viewer.canvas.toDataURL("image/png"), download: `${document.title}.png` });
  link.click();
}
