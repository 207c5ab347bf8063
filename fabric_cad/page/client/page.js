"use strict";
// The page of one fabric: its view, and what can be shown and hidden in it.
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const canvas = document.getElementById("view"), view = fabricView(canvas);
  if (!view) {
    canvas.replaceWith(Object.assign(document.createElement("p"), {
      className: "note", textContent: "This browser has no WebGL2, by which the cell is drawn."}));
    return;
  }
  const named = name => document.getElementById(name);
  function apply() {
    const cells = Number(named("cells").value), axis = named("cut-axis").value;
    const period = scene.period[axis === "y" ? 1 : 0] * cells;
    const hidden = [];
    for (const group of scene.groups)
      if (!named(`show-${group.direction}`).checked)
        for (const yarn of new Set(group.yarn)) hidden.push(`${group.direction}_${yarn + 1}`);
    named("cut-place").disabled = !axis;
    view.set({
      cells: [cells, cells], hidden, contact: named("contact").checked,
      cut: axis ? {axis, place: named("cut-place").value * period} : null,
    });
  }
  for (const control of document.querySelectorAll(".controls input, .controls select"))
    control.addEventListener("input", apply);
  view.show(scene);
  apply();
  window.fabric = view;
})();
