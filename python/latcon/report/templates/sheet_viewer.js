// The sheet of a run in motion, on a canvas: data of sheet_reader.js, elements of macros.html. Lengths in m, times in s.
"use strict";

/** Numbers of a list of steps. */
const scaled = (steps, quantum) => new Float64Array(steps).map((step) => step * quantum);
const css = (colour) => `rgb(${colour & 255},${colour >> 8 & 255},${colour >> 16 & 255})`;
const themed = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
/** Calls a function when the page becomes dark or light, or is printed. */
const onNewColours = (draw) => ["(prefers-color-scheme: dark)", "print"].forEach(
  (query) => matchMedia(query).addEventListener("change", draw));
const QUANTITIES = {
  stretch: {name: "stretch of bonds", unit: "1", root: false},
  speed: {name: "speed of the material", unit: "m/s", root: true}, // waves are seen by the root
  damage: {name: "damage, fraction of bonds broken", unit: "1", root: false},
};
const DETAIL = 9; // distance of sites from which on bonds are drawn one by one [pixels]
const SECONDS = 6; // a film takes
const INSET_SPACINGS = 30; // width of the picture near the tip

class SheetViewer {
  constructor(root, sheet) {
    this.root = root;
    this.sheet = sheet;
    this.part = (name) => root.querySelector(`.${name}`);
    this.views = [{canvas: this.part("sheet"), zoom: 1, x: 0, y: 0}];
    if (sheet.tip) this.views.push({canvas: this.part("near-tip"), zoom: 1, x: 0, y: 0, followsTip: true});
    this.quantity = "speed";
    this.deformed = true;
    this.picked = null;
    this.frame = sheet.times.length - 1;
    this.evaluate();
    this.pitch = {true: this.meanLength(0), false: this.meanLength(null)};
    this.listen();
    this.resize();
  }

  /** Mean distance of nearest neighbours in a frame; undeformed for null. */
  meanLength(frame) {
    const {bonds, length, position, quantum, spacing} = this.sheet;
    const now = frame === null ? length : lengths(position[frame], bonds).map((steps) => steps * quantum);
    let sum = 0, count = 0;
    length.forEach((undeformed, i) => { if (undeformed < 1.3 * spacing) { sum += now[i]; count++; } });
    return count ? sum / count : spacing;
  }

  /** Positions, and values of sites and bonds, of this frame. */
  evaluate() {
    const {sheet, frame} = this, {bonds: [from, to], bondEnd, degree, quantum} = sheet;
    const now = sheet.position[frame].map((steps) => scaled(steps, quantum));
    const n = degree.length, alive = new Uint16Array(n);
    for (let i = 0; i < from.length; i++) if (bondEnd[i] > frame) { alive[from[i]]++; alive[to[i]]++; }
    this.current = now;
    this.place = this.deformed ? now : sheet.reference;
    this.stretch = lengths(now, sheet.bonds).map((length, i) => length / sheet.length[i]);
    this.speed = scaled(sheet.speed[frame], sheet.speedQuantum);
    this.damage = new Float64Array(n).map((_, i) => 1 - alive[i] / degree[i]);
    this.bondValue = this.quantity === "stretch" ? this.stretch
      : this.stretch.map((_, i) => (this[this.quantity][from[i]] + this[this.quantity][to[i]]) / 2);
    // Bonds of sites that have lost some, or are in no whole triangle, are drawn one by one.
    this.torn = new Uint8Array(n).fill(1);
    const [a, b, c] = sheet.triangles;
    for (let i = 0; i < a.length; i++)
      if (sheet.triangleEnd[i] > frame) this.torn[a[i]] = this.torn[b[i]] = this.torn[c[i]] = 0;
    for (let i = 0; i < from.length; i++) if (bondEnd[i] <= frame) this.torn[from[i]] = this.torn[to[i]] = 1;
    this.siteValue = this[this.quantity];
    if (this.quantity !== "stretch") return;
    const sum = new Float64Array(n); // a site has the mean stretch of its bonds, 1 without bonds
    for (let i = 0; i < from.length; i++)
      if (bondEnd[i] > frame) { sum[from[i]] += this.stretch[i]; sum[to[i]] += this.stretch[i]; }
    this.siteValue = sum.map((value, i) => alive[i] ? value / alive[i] : 1);
  }

  /** Place of a value in the colour table. */
  shade(value) {
    const [low, high] = this.sheet.ranges[this.quantity];
    const share = (value - low) / (high - low);
    if (share > 1 + 1e-9) return 256;
    return Math.round(255 * (QUANTITIES[this.quantity].root ? Math.sqrt(Math.max(share, 0)) : Math.max(share, 0)));
  }

  // Views: x, y is the middle relative to where the view follows, zoom 1 shows all.

  box() {
    const span = (values) => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
    const ends = this.deformed ? this.sheet.box : this.sheet.reference.map(span);
    const margin = 0.02 * Math.max(ends[0][1] - ends[0][0], ends[1][1] - ends[1][0]);
    return ends.map(([low, high]) => [low - margin, high + margin]);
  }

  /** Middle of a view, and pixels per metre. */
  frameOf(view) {
    const {width, height} = view.canvas;
    if (view.followsTip) {
      const tip = this.sheet.tip[this.frame];
      const all = width / (INSET_SPACINGS * this.pitch[this.deformed]);
      return {x: this.place[0][tip] + view.x, y: this.place[1][tip] + view.y, scale: all * view.zoom};
    }
    const [[left, right], [bottom, top]] = this.whole;
    const all = Math.min(width / (right - left), height / (top - bottom));
    return {x: (left + right) / 2 + view.x, y: (bottom + top) / 2 + view.y, scale: all * view.zoom};
  }

  resize() {
    this.whole = this.box();
    const [[left, right], [bottom, top]] = this.whole;
    this.views[0].canvas.style.aspectRatio = Math.min(Math.max((right - left) / (top - bottom), 0.8), 8);
    for (const {canvas} of this.views) {
      const density = Math.min(devicePixelRatio || 1, 2), {clientWidth, clientHeight} = canvas;
      canvas.width = Math.max(1, Math.round(clientWidth * density));
      canvas.height = Math.max(1, Math.round(clientHeight * density));
    }
    this.draw();
  }

  draw() {
    this.views.forEach((view) => this.paint(view));
    this.describe();
  }

  paint(view) {
    const {canvas} = view, {width, height} = canvas, context = canvas.getContext("2d");
    const {x, y, scale} = this.frameOf(view), count = this.place[0].length;
    const px = new Float32Array(count), py = new Float32Array(count);
    for (let i = 0; i < count; i++) {
      px[i] = (this.place[0][i] - x) * scale + width / 2;
      py[i] = height / 2 - (this.place[1][i] - y) * scale;
    }
    view.px = px;
    view.py = py;
    const image = context.createImageData(width, height), pixels = new Uint32Array(image.data.buffer);
    const detailed = this.pitch[this.deformed] * scale > DETAIL;
    if (!detailed) this.fillTriangles(pixels, width, height, px, py);
    context.putImageData(image, 0, 0);
    this.drawBonds(context, width, height, px, py, detailed, this.pitch[this.deformed] * scale);
    this.drawMarks(context, view, scale);
  }

  fillTriangles(pixels, width, height, px, py) {
    const {triangles: [first, second, third], triangleEnd, colours} = this.sheet, table = colours[this.quantity];
    for (let i = 0; i < first.length; i++) {
      if (triangleEnd[i] <= this.frame) continue;
      const a = first[i], b = second[i], c = third[i];
      const left = Math.max(0, Math.ceil(Math.min(px[a], px[b], px[c]) - 0.5));
      const right = Math.min(width - 1, Math.floor(Math.max(px[a], px[b], px[c]) - 0.5));
      const top = Math.max(0, Math.ceil(Math.min(py[a], py[b], py[c]) - 0.5));
      const bottom = Math.min(height - 1, Math.floor(Math.max(py[a], py[b], py[c]) - 0.5));
      if (left > right || top > bottom) continue;
      const colour = table[this.shade((this.siteValue[a] + this.siteValue[b] + this.siteValue[c]) / 3)];
      const turn = (px[b] - px[a]) * (py[c] - py[a]) - (px[c] - px[a]) * (py[b] - py[a]) < 0 ? -1 : 1;
      for (let row = top; row <= bottom; row++) {
        const v = row + 0.5;
        for (let column = left; column <= right; column++) {
          const u = column + 0.5;
          if (turn * ((px[b] - px[a]) * (v - py[a]) - (u - px[a]) * (py[b] - py[a])) >= 0 &&
              turn * ((px[c] - px[b]) * (v - py[b]) - (u - px[b]) * (py[c] - py[b])) >= 0 &&
              turn * ((px[a] - px[c]) * (v - py[c]) - (u - px[c]) * (py[a] - py[c])) >= 0)
            pixels[row * width + column] = colour;
        }
      }
    }
  }

  /** Bonds as lines, those of one colour at once; all where there is room, otherwise those that are torn. */
  drawBonds(context, width, height, px, py, all, pitch) {
    const {bonds: [from, to], bondEnd, colours} = this.sheet, lines = new Map();
    for (let i = 0; i < from.length; i++) {
      const a = from[i], b = to[i];
      if (bondEnd[i] <= this.frame || !(all || this.torn[a] || this.torn[b])) continue;
      if (Math.max(px[a], px[b]) < 0 || Math.min(px[a], px[b]) > width) continue;
      if (Math.max(py[a], py[b]) < 0 || Math.min(py[a], py[b]) > height) continue;
      const shade = this.shade(this.bondValue[i]);
      if (!lines.has(shade)) lines.set(shade, []);
      lines.get(shade).push(a, b);
    }
    const table = colours[this.quantity];
    context.lineWidth = all ? Math.min(4, Math.max(1.2, pitch / 9)) : 1;
    for (const [shade, ends] of [...lines].sort(([one], [other]) => one - other)) { // the largest on top
      context.strokeStyle = css(table[shade]);
      context.beginPath();
      for (let i = 0; i < ends.length; i += 2) {
        context.moveTo(px[ends[i]], py[ends[i]]);
        context.lineTo(px[ends[i + 1]], py[ends[i + 1]]);
      }
      context.stroke();
    }
    if (!all) return;
    const radius = Math.min(5, pitch / 7);
    for (let i = 0; i < px.length; i++) {
      if (px[i] < 0 || px[i] > width || py[i] < 0 || py[i] > height) continue;
      context.fillStyle = css(table[this.shade(this.siteValue[i])]);
      context.beginPath();
      context.arc(px[i], py[i], radius, 0, 7);
      context.fill();
    }
  }

  /** Scale bar, tip, and what is picked. */
  drawMarks(context, view, scale) {
    const {canvas, px, py, followsTip} = view, density = canvas.width / canvas.clientWidth || 1;
    const text = themed("--text"), left = 8 * density, low = canvas.height - 8 * density;
    context.lineWidth = 1.5 * density;
    context.strokeStyle = context.fillStyle = text;
    const steps = [1, 2, 5], wanted = 0.2 * canvas.width / scale, decade = 10 ** Math.floor(Math.log10(wanted));
    const bar = decade * Math.max(...steps.filter((step) => step * decade <= wanted), 1);
    context.font = `${12 * density}px system-ui, sans-serif`;
    const label = bar >= 0.01 ? `${+(100 * bar).toPrecision(2)} cm` : `${+(1000 * bar).toPrecision(2)} mm`;
    context.shadowColor = themed("--page"); // a halo, on whatever is below
    context.shadowBlur = 3 * density;
    for (let again = 0; again < 4; again++) {
      context.fillRect(left, low - 3 * density, bar * scale, 3 * density);
      context.fillText(label, left, low - 7 * density);
    }
    if (this.sheet.tip && !followsTip) {
      const tip = this.sheet.tip[this.frame];
      context.beginPath();
      context.arc(px[tip], py[tip], 7 * density, 0, 7);
      context.stroke();
    }
    context.shadowBlur = 0;
    if (!this.picked) return;
    const {site, bond} = this.picked;
    context.strokeStyle = themed("--fails");
    context.lineWidth = 2 * density;
    context.beginPath();
    context.arc(px[site], py[site], 5 * density, 0, 7);
    if (bond !== null) {
      const a = this.sheet.bonds[0][bond], b = this.sheet.bonds[1][bond];
      context.moveTo(px[a], py[a]);
      context.lineTo(px[b], py[b]);
    }
    context.stroke();
  }

  /** Site nearest to a point of a view, and the unbroken bond nearest to it; null away from both. */
  pick(view, u, v) {
    const {px, py} = view, {bonds: [from, to], bondEnd} = this.sheet, {scale} = this.frameOf(view);
    let site = 0, nearest = Infinity;
    for (let i = 0; i < px.length; i++) {
      const distance = (px[i] - u) ** 2 + (py[i] - v) ** 2;
      if (distance < nearest) { nearest = distance; site = i; }
    }
    const reach = Math.max(10 * (devicePixelRatio || 1), 0.8 * this.pitch[this.deformed] * scale);
    let bond = null, closest = reach ** 2;
    for (let i = 0; i < from.length; i++) {
      if (bondEnd[i] <= this.frame) continue;
      const ax = px[from[i]], ay = py[from[i]], dx = px[to[i]] - ax, dy = py[to[i]] - ay, size = dx * dx + dy * dy;
      const along = size > 0 ? Math.min(1, Math.max(0, ((u - ax) * dx + (v - ay) * dy) / size)) : 0;
      const distance = (ax + along * dx - u) ** 2 + (ay + along * dy - v) ** 2;
      if (distance < closest) { closest = distance; bond = i; }
    }
    return Math.sqrt(nearest) <= reach || bond !== null ? {site, bond} : null;
  }

  /** Words and numbers around the pictures. */
  describe() {
    const {sheet, frame, picked} = this, cm = (value) => (100 * value).toFixed(4);
    this.part("slider").value = frame;
    this.part("time").textContent = `${(1e3 * sheet.times[frame]).toFixed(3)} ms`;
    const {name, unit, root} = QUANTITIES[this.quantity], [low, high] = sheet.ranges[this.quantity];
    const table = sheet.colours[this.quantity], stops = [0, 51, 102, 153, 204, 255].map((i) => css(table[i]));
    this.part("colour-bar").style.background = `linear-gradient(to right, ${stops.join(",")})`;
    const middle = low + (high - low) * (root ? 0.25 : 0.5);
    const ends = [low, middle, high].map((end) => `<span>${+end.toPrecision(3)}</span>`);
    this.part("colour-ends").innerHTML = ends.join("");
    const beyond = this.quantity === "stretch" && sheet.breaking ? "; orange: beyond the breaking stretch" : "";
    this.part("colour-name").textContent = `${name} [${unit}]${beyond}`;
    const said = this.part("values");
    said.textContent = said.dataset.hint;
    if (!picked) return;
    const {site, bond} = picked, [X, Y] = sheet.reference, [x, y] = this.current;
    said.textContent = `site ${sheet.site[site]}: X ${cm(X[site])} cm, Y ${cm(Y[site])} cm, ` +
      `x ${cm(x[site])} cm, y ${cm(y[site])} cm, ` +
      `speed ${this.speed[site].toFixed(2)} m/s, damage ${this.damage[site].toFixed(3)}`;
    if (bond === null) return;
    const atEnds = sheet.bonds.map((end) => sheet.site[end[bond]]);
    said.textContent += `; bond ${atEnds.join("–")}: stretch ${this.stretch[bond].toFixed(3)}`;
  }

  /** Shows a frame. */
  show(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.sheet.times.length - 1);
    this.update();
    const tip = this.sheet.tip ? this.sheet.reference[0][this.sheet.tip[this.frame]] : null;
    this.root.dispatchEvent(new CustomEvent("frame", {bubbles: true, detail: {time: this.sheet.times[this.frame], tip}}));
  }

  update() {
    this.evaluate();
    this.draw();
  }

  play(playing) {
    this.playing = playing;
    const button = this.part("play"), {times} = this.sheet, end = times.length - 1;
    button.textContent = playing ? "❚❚" : "▶";
    button.setAttribute("aria-label", playing ? "pause" : "play");
    if (!playing) return;
    let from = this.frame === end ? 0 : this.frame, begin = null;
    if (from !== this.frame) this.show(from);
    const step = (now) => {
      if (!this.playing) return;
      begin ??= now;
      const time = times[from] + (now - begin) / (1e3 * SECONDS) * (times[end] - times[0]);
      let frame = this.frame;
      while (frame < end && times[frame + 1] <= time) frame++;
      if (frame !== this.frame) this.show(frame);
      if (frame === end) this.play(false); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  /** Enlarges a view about a point of its canvas. */
  zoom(view, factor, u = view.canvas.width / 2, v = view.canvas.height / 2) {
    const before = this.frameOf(view).scale;
    view.zoom = Math.min(Math.max(view.zoom * factor, 1), 400);
    const after = this.frameOf(view).scale, shift = 1 / before - 1 / after;
    view.x += (u - view.canvas.width / 2) * shift;
    view.y -= (v - view.canvas.height / 2) * shift;
    if (view.zoom === 1) view.x = view.y = 0;
    view.canvas.style.touchAction = view.zoom > 1 ? "none" : "pan-y";
    this.draw();
  }

  listen() {
    const [sheet] = this.views;
    const slider = this.part("slider");
    slider.max = this.sheet.times.length - 1;
    slider.addEventListener("input", () => { this.play(false); this.show(+slider.value); });
    this.part("play").addEventListener("click", () => this.play(!this.playing));
    this.part("colour").addEventListener("change", (event) => { this.quantity = event.target.value; this.update(); });
    this.part("configuration").addEventListener("change", (event) => {
      this.deformed = event.target.value === "deformed";
      this.picked = null;
      for (const view of this.views) Object.assign(view, {zoom: 1, x: 0, y: 0});
      this.evaluate();
      this.resize();
    });
    this.part("closer").addEventListener("click", () => this.zoom(sheet, 1.6));
    this.part("farther").addEventListener("click", () => this.zoom(sheet, 1 / 1.6));
    this.part("reset").addEventListener("click", () => { for (const view of this.views) this.zoom(view, 0); });
    this.views.forEach((view) => this.listenTo(view));
    new ResizeObserver(() => this.resize()).observe(sheet.canvas);
    onNewColours(() => this.draw());
  }

  listenTo(view) {
    const {canvas} = view, fingers = new Map();
    const place = (event) => {
      const density = canvas.width / canvas.clientWidth;
      return [event.offsetX * density, event.offsetY * density];
    };
    const span = () => {
      const [one, other] = [...fingers.values()];
      return Math.hypot(one[0] - other[0], one[1] - other[1]);
    };
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, place(event));
      canvas.setPointerCapture(event.pointerId);
    });
    for (const kind of ["pointerup", "pointercancel"])
      canvas.addEventListener(kind, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      const [u, v] = place(event), last = fingers.get(event.pointerId);
      if (last && fingers.size === 2) {
        const before = span();
        fingers.set(event.pointerId, [u, v]);
        if (before > 0) this.zoom(view, span() / before, u, v);
      } else if (last && view.zoom > 1) {
        const {scale} = this.frameOf(view);
        view.x -= (u - last[0]) / scale;
        view.y += (v - last[1]) / scale;
        fingers.set(event.pointerId, [u, v]);
        this.draw();
      } else {
        const {picked} = this, found = this.picked = this.pick(view, u, v);
        if (found?.site !== picked?.site || found?.bond !== picked?.bond) this.draw();
      }
    });
    canvas.addEventListener("pointerleave", () => {
      if (this.picked) { this.picked = null; this.draw(); }
    });
    // A wheel scrolls the page unless the picture was clicked.
    canvas.addEventListener("wheel", (event) => {
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(view, event.deltaY < 0 ? 1.25 : 0.8, ...place(event));
    }, {passive: false});
    canvas.addEventListener("dblclick", (event) => this.zoom(view, 2, ...place(event)));
  }
}

for (const root of document.querySelectorAll(".viewer"))
  (async () => {
    if (typeof DecompressionStream === "undefined") throw new Error("this browser has no DecompressionStream");
    const sheet = await readSheet(JSON.parse(document.getElementById(root.dataset.sheet).textContent));
    root.viewer = new SheetViewer(root, sheet);
    root.viewer.show(root.viewer.frame);
    root.classList.add("ready");
  })().catch((error) => {
    root.querySelector(".values").textContent = `The sheet cannot be shown: ${error.message}. Pictures of it are below.`;
    console.error(error);
  });

/** Viewers side by side show the same time, or their frame nearest to it, and the same colour and configuration. */
for (const pair of document.querySelectorAll(".pair")) {
  const others = (root) => [...pair.querySelectorAll(".viewer.ready")].filter((other) => other !== root);
  let following = false;
  pair.addEventListener("frame", ({target, detail}) => {
    if (following) return;
    following = true;
    for (const {viewer} of others(target)) {
      viewer.play(false);
      const away = viewer.sheet.times.map((time) => Math.abs(time - detail.time));
      viewer.show(away.indexOf(Math.min(...away)));
    }
    following = false;
  });
  pair.addEventListener("change", ({target}) => {
    if (following || target.tagName !== "SELECT") return;
    following = true;
    for (const root of others(target.closest(".viewer"))) {
      const own = root.querySelector(`.${target.className}`);
      own.value = target.value;
      own.dispatchEvent(new Event("change", {bubbles: true}));
    }
    following = false;
  });
}
