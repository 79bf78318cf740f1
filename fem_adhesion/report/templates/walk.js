"use strict";
// The moving figure: four panels that show the state chosen by the slider or by pointing at the curve.
(() => {
  const data = JSON.parse(document.getElementById("walk-data").textContent);
  const states = data.stations;
  const slider = document.getElementById("state");
  const readout = document.getElementById("readout");
  const WIDTH = 420, HEIGHT = 300, LEFT = 46, RIGHT = 10, TOP = 10, BOTTOM = 26;
  const SVG = "http://www.w3.org/2000/svg";

  const element = (parent, name, attributes, text) => {
    const made = document.createElementNS(SVG, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    parent.appendChild(made);
    return made;
  };

  const ticks = ([least, most]) => {
    const raw = (most - least) / 7, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 2.5, 5, 10].find((factor) => factor * power >= raw);
    const found = [];
    for (let value = Math.ceil(least / step) * step; value <= most + 1e-9; value += step) found.push(value);
    return found;
  };

  // A panel with fixed ranges: scales, axes, and a group that is drawn anew for each state.
  const panel = (id, xRange, yRange) => {
    const svg = document.getElementById(id);
    const x = (value) => LEFT + (value - xRange[0]) / (xRange[1] - xRange[0]) * (WIDTH - LEFT - RIGHT);
    const y = (value) => HEIGHT - BOTTOM - (value - yRange[0]) / (yRange[1] - yRange[0]) * (HEIGHT - TOP - BOTTOM);
    const clip = `clip-${id}`;
    element(element(svg, "clipPath", { id: clip }), "rect", { x: LEFT, y: TOP, width: WIDTH - LEFT - RIGHT, height: HEIGHT - TOP - BOTTOM });
    for (const value of ticks(xRange)) {
      element(svg, "path", { class: "axis", d: `M${x(value)} ${HEIGHT - BOTTOM}v4` });
      element(svg, "text", { x: x(value), y: HEIGHT - 8, "text-anchor": "middle" }, String(+value.toPrecision(3)));
    }
    for (const value of ticks(yRange)) {
      element(svg, "path", { class: "axis", d: `M${LEFT} ${y(value)}h-4` });
      element(svg, "text", { x: LEFT - 7, y: y(value) + 4, "text-anchor": "end" }, String(+value.toPrecision(3)));
    }
    element(svg, "path", { class: "axis", d: `M${LEFT} ${TOP}V${HEIGHT - BOTTOM}H${WIDTH - RIGHT}` });
    const drawing = element(svg, "g", { "clip-path": `url(#${clip})` });
    const line = (kind, xs, ys, parent = drawing) => {
      let d = "", pen = "M";
      ys.forEach((value, k) => {
        if (value === null) { pen = "M"; return; }
        d += `${pen}${x(xs[k]).toFixed(1)} ${y(value).toFixed(1)}`;
        pen = "L";
      });
      if (d) element(parent, "path", { class: kind, d });
    };
    return { svg, x, y, drawing, line, clear: () => drawing.replaceChildren() };
  };

  const range = (values, margin) => {
    const kept = values.filter((value) => value !== null);
    const least = Math.min(...kept), most = Math.max(...kept), more = margin * (most - least);
    return [least - more, most + more];
  };

  // Ranges: the curve where something happens, the profiles over all states near contact.
  const near = states.filter((state) => state.load < -0.05 * Math.abs(Math.min(...states.map((s) => s.load))) || state.approach > 0);
  const curve = panel("curve", range(near.map((s) => s.approach), 0.05), range(near.map((s) => s.load), 0.08));
  const radii = [0, data.radii[data.radii.length - 1]];
  const pressure = panel("pressure", radii, range(near.flatMap((s) => s.pressure[0]), 0.05));
  const highest = Math.max(...near.map((s) => s.central_gap)) + 4;
  const gap = panel("gap", radii, [-0.5, highest]);
  const between = data.between; // heights in eps per beta of depth at which the lines inside the body are drawn
  const heights = near.flatMap((s) => s.lines.flatMap((rises, line) => rises.map((rise) => rise - between * data.depths[line])));
  const body = panel("body", radii, [Math.min(...heights) - 0.5, Math.max(...heights) + 5]);

  for (const [kind, drawn] of [["fe", data.curves[0]], ["hs", data.curves[1]]]) {
    curve.line(kind, drawn.approach, drawn.load.map((load, k) => (drawn.unstable[k] ? null : load)));
    curve.line("unstable", drawn.approach, drawn.load.map((load, k) => (drawn.unstable[k] ? load : null)));
  }
  const dots = element(curve.drawing, "g", {});
  states.forEach((state) => {
    const dot = element(dots, "circle", { class: state.stable ? "station" : "station passing", cx: curve.x(state.approach), cy: curve.y(state.load), r: state.name ? 4 : 2.5 });
    element(dot, "title", {}, `${state.name || "state"}: α* ${state.approach}, W ${state.load}`);
  });
  const here = element(curve.drawing, "circle", { class: "here", r: 6, "pointer-events": "none" });
  const point = (event) => {
    const box = curve.svg.getBoundingClientRect(), scale = WIDTH / box.width;
    const px = (event.clientX - box.left) * scale, py = (event.clientY - box.top) * scale;
    let best = 0, least = Infinity;
    states.forEach((state, k) => {
      const away = Math.hypot(curve.x(state.approach) - px, curve.y(state.load) - py);
      if (away < least) { least = away; best = k; }
    });
    if (least < 25) choose(best);
  };
  for (const kind of ["pointermove", "pointerdown"]) curve.svg.addEventListener(kind, point);

  const number = (value, digits = 4) => (value === null ? "none" : value.toFixed(digits));

  const show = (k) => {
    const state = states[k];
    here.setAttribute("cx", curve.x(state.approach));
    here.setAttribute("cy", curve.y(state.load));
    for (const [shown, values] of [[pressure, state.pressure], [gap, state.gap]]) {
      shown.clear();
      shown.line("axis", radii, [0, 0]);
      shown.line("fe", data.radii, values[0]);
      shown.line("hs", data.radii, values[1]);
    }
    body.clear();
    const sphere = data.radii.map((r) => `L${body.x(r).toFixed(1)} ${body.y(1 - state.approach + data.tabor * r * r / 2).toFixed(1)}`);
    element(body.drawing, "path", { class: "wall", d: `M${body.x(0)} -9999${sphere.join("")}V-9999Z` });
    data.depths.forEach((depth, line) => body.line(line ? "fe inner" : "fe", data.places, state.lines[line].map((rise) => rise - between * depth)));
    readout.textContent = `${state.name ? state.name + ": " : ""}state ${k + 1} of ${states.length}, `
      + `${state.stable ? "stable" : "unstable"} under fixed grips. α* = ${number(state.approach)} ε, W = ${number(state.load)} R Δγ, `
      + `H(0) = ${number(state.central_gap)} ε, contact radius ${number(state.contact_radius)}${state.contact_radius === null ? "" : " β"}.`;
    slider.setAttribute("aria-valuetext", readout.textContent);
  };

  const choose = (k) => {
    slider.value = k;
    show(k);
  };

  slider.max = states.length - 1;
  slider.addEventListener("input", () => show(Number(slider.value)));
  choose(Math.max(0, states.findIndex((state) => state.name === "pull off")));
})();
