// Plots of the path and of the energies, by dygraphs; data of crack_section.py, elements of macros.html.
"use strict";

/** Values of all curves at a point, for the line below a plot. */
function legend(plot, {x, series}, row) {
  const text = (value) => value === null || value === undefined || Number.isNaN(value) ? "–" : String(+value.toPrecision(5));
  const parts = plot.labels.slice(1).map((label, i) => {
    const colour = series[i]?.color ?? themed(plot.colours[i]);
    const value = row === null ? "" : ` <b>${text(plot.rows[row][i + 1])}</b>`;
    const line = `<i class="${plot.dashed[i] ? "dashed" : ""}" style="border-color:${colour}"></i>`;
    return `<span class="entry">${line}${label}${value}</span>`;
  });
  return `${x === undefined ? "" : `<span class="entry">${plot.labels[0]} <b>${text(x)}</b></span>`}${parts.join("")}`;
}

/** Rows as they are drawn: shares of energy on top of each other. */
function stacked(plot) {
  if (!plot.stacked) return plot.rows;
  return plot.rows.map((row) => {
    let sum = 0;
    return row.map((value, i) => i >= plot.stacked ? sum += value : value);
  });
}

function drawPlot(figure, viewer) {
  const plot = JSON.parse(document.getElementById(figure.dataset.plot).textContent);
  // The legend is HTML, and names of folders are not.
  const labels = plot.labels = plot.labels.map((label) => label.replace(/[&<]/g, (letter) => `&#${letter.charCodeAt()};`));
  let cursor = null;
  const look = () => ({
    colors: plot.colours.map(themed),
    gridLineColor: themed("--line"),
    axisLineColor: themed("--soft"),
  });
  const options = {
    labels,
    labelsDiv: figure.querySelector(".legend"),
    legend: "always",
    legendFormatter: (data) => {
      const row = data.x === undefined ? null : plot.rows.findIndex((values) => values[0] === data.x);
      return legend(plot, data, row === -1 ? null : row);
    },
    xlabel: plot.x,
    ylabel: plot.y,
    xLabelHeight: 18,
    yLabelWidth: 18,
    axisLabelFontSize: 12,
    strokeWidth: 2,
    highlightCircleSize: 4,
    connectSeparatedPoints: false,
    includeZero: Boolean(plot.stacked),
    animatedZooms: false,
    axes: {y: {axisLabelWidth: 56}},
    series: Object.fromEntries(labels.slice(1).map((label, i) => [label, {
      ...(plot.dashed[i] ? {strokePattern: [7, 4]} : {}),
      ...(plot.stacked && i + 1 >= plot.stacked ? {fillGraph: true, fillAlpha: 1, strokeWidth: 0.5} : {}),
    }])),
    underlayCallback: (context, area, graph) => {
      if (!plot.window) return;
      const [begin, end] = plot.window.map((x) => graph.toDomXCoord(x));
      context.fillStyle = themed("--card");
      context.fillRect(begin, area.y, end - begin, area.h);
    },
    drawCallback: drawCursor,
    // Fingers scroll the page; a tap shows the values.
    interactionModel: Object.fromEntries(
      Object.entries(Dygraph.defaultInteractionModel).filter(([name]) => !name.startsWith("touch"))),
    ...look(),
  };
  /** The time of the sheet above, on top of all curves. */
  function drawCursor(graph) {
    if (cursor === null) return;
    const context = graph.canvas_ctx_, area = graph.getArea(), x = graph.toDomXCoord(cursor);
    if (x < area.x || x > area.x + area.w) return;
    context.save();
    context.strokeStyle = themed("--text");
    context.setLineDash([2, 3]);
    context.beginPath();
    context.moveTo(x, area.y);
    context.lineTo(x, area.y + area.h);
    context.stroke();
    context.restore();
  }
  const graph = figure.graph = new Dygraph(figure.querySelector(".plot"), stacked(plot), options);
  viewer?.addEventListener("frame", ({detail}) => {
    cursor = plot.follows === "tip" ? detail.tip && 100 * detail.tip : 1e3 * detail.time;
    graph.clearSelection(); // wipes the upper canvas
    drawCursor(graph);
  });
  onNewColours(() => graph.updateOptions(look()));
}

for (const figure of document.querySelectorAll(".live"))
  drawPlot(figure, figure.dataset.viewer ? document.getElementById(figure.dataset.viewer) : null);

/** What a link points to is unfolded. */
function unfold() {
  for (let at = document.getElementById(decodeURIComponent(location.hash.slice(1))); at; at = at.parentElement)
    if (at.tagName === "DETAILS") at.open = true;
  document.getElementById(location.hash.slice(1))?.querySelector(":scope > details")?.setAttribute("open", "");
}
addEventListener("hashchange", unfold);
unfold();
