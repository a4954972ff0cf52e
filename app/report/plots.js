// The plots over time, drawn by uPlot. Cursor and zoom of one plot are those of all.

const lineColors = ["--line-1", "--line-2", "--line-3", "--line-4"];
// The lines can be told apart on a grey print too.
const lineDashes = [[], [9, 3], [4, 3], [10, 3, 2, 3]];
const plots = [];

function colorOf(variable) {
  return getComputedStyle(document.documentElement).getPropertyValue(variable).trim();
}

/** Returns the least and the greatest value of the axis: a flat line is in the middle. */
function valueRange(plot, low, high) {
  if (low === null || high === null) return [0, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  // Seven digits are here. What differs less is flat.
  if (high - low <= 2e-6 * size || size === 0) {
    const margin = size === 0 ? 1 : 0.1 * size;
    return [low - margin, high + margin];
  }
  const margin = 0.1 * (high - low);
  return [low >= 0 && low < 0.5 * high ? 0 : low - margin, high + margin];
}

function axisLabels(plot, splits) {
  return splits.map((value) => (value === null ? null : numberText(value, 6)));
}

/** Distances between the labels of counts: there is no half of a piece. */
const wholeSteps = [];
for (let power = 1; power < 1e12; power *= 10) wholeSteps.push(power, 2 * power, 5 * power);

function axis(extra) {
  return {
    stroke: () => colorOf("--faint"),
    grid: { stroke: () => colorOf("--grid"), width: 1 },
    ticks: { stroke: () => colorOf("--grid"), width: 1 },
    font: "12px system-ui, sans-serif",
    values: axisLabels,
    ...extra,
  };
}

/** Shows the same part of the time in all plots. */
function zoomAll(from, to) {
  for (const plot of plots) {
    const scale = plot.scales.x;
    if (scale.min !== from || scale.max !== to) plot.setScale("x", { min: from, max: to });
  }
  const time = plots[0].data[0];
  byId("reset-zoom").hidden = from <= time[0] && to >= time[time.length - 1];
}

function zoomOut() {
  const time = plots[0].data[0];
  zoomAll(time[0], time[time.length - 1]);
}

/** Marks the times of edits at the upper edge of a plot. */
function drawEditMarks(plot, times) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.fillStyle = colorOf("--accent");
  ctx.globalAlpha = 0.6;
  let last = -1;
  for (const time of times) {
    const x = Math.round(plot.valToPos(time, "x", true));
    if (x === last || x < bbox.left || x > bbox.left + bbox.width) continue;
    ctx.fillRect(x, bbox.top, devicePixelRatio, 4 * devicePixelRatio);
    last = x;
  }
  ctx.restore();
}

function optionsOf(chart, width, editTimes) {
  const isCount = chart.stepped && chart.unit === "";
  return {
    width,
    height: 200,
    cursor: { sync: { key: "time" }, points: { size: 6 }, focus: { prox: 24 } },
    focus: { alpha: 0.4 },
    scales: { x: { time: false }, y: { range: valueRange } },
    axes: [
      axis({ label: "time in s", labelSize: 18, labelFont: "12px system-ui, sans-serif",
        size: 34 }),
      axis({ size: 66, ...(isCount ? { incrs: wholeSteps } : {}) }),
    ],
    series: [
      { label: "t", value: (plot, value) => (value === null ? "–" : `${numberText(value, 5)} s`) },
      ...chart.series.map((series, i) => ({
        label: series.label,
        stroke: () => colorOf(lineColors[i % lineColors.length]),
        dash: lineDashes[i % lineDashes.length],
        width: 1.6,
        paths: chart.stepped ? uPlot.paths.stepped({ align: 1 }) : undefined,
        points: { show: series.values.length < 2 },
        value: (plot, value) => numberText(value, 5),
      })),
    ],
    hooks: {
      setScale: [(plot, key) => {
        if (key === "x" && plots.length > 0 && plot.isReady)
          zoomAll(plot.scales.x.min, plot.scales.x.max);
      }],
      draw: [(plot) => drawEditMarks(plot, editTimes)],
      ready: [(plot) => { plot.isReady = true; }],
    },
  };
}

/** The width of a plot on paper, two of which are side by side on a sheet of A4 or letter. */
const paperWidth = 320;

/** Returns the width for a plot in its box, without padding and border. */
function widthIn(box) {
  return Math.max(240, box.clientWidth - 27);
}

function setWidth(plot, width) {
  if (width !== plot.width) plot.setSize({ width, height: plot.height });
}

/** Draws all plots into the page. */
function showPlots(data, editTimes) {
  const list = byId("plot-list");
  if (data.time.length === 0) {
    byId("plot-note").textContent = "The run has written no rows to history.csv.";
    return;
  }
  byId("plot-note").textContent =
    "Point at a plot to read values at the same time in all of them. Drag to zoom; " +
    "double-click to see the whole time. Click on a name to hide its line. Units are SI, or " +
    "those of the scenario. " +
    (editTimes.length > 0 ? "Marks at the upper edge are edits." : "") +
    (data.time.length < data.rows ?
      ` The plots show ${numberText(data.time.length)} of ${numberText(data.rows)} rows of ` +
      "history.csv, with the lowest and the highest value of each column." : "");
  for (const chart of data.charts) {
    const title = element("h3", {}, chart.title);
    if (chart.unit) title.append(element("span", { class: "unit" }, ` in ${chart.unit}`));
    const box = element("div", { class: "plot" }, title,
      element("p", { class: "note" }, chart.note));
    list.append(box);
    const plot = new uPlot(optionsOf(chart, widthIn(box), editTimes),
      [data.time, ...chart.series.map((series) => series.values)], box);
    const canvas = plot.root.querySelector("canvas");
    canvas.setAttribute("aria-label", chart.title);
    canvas.setAttribute("role", "img");
    plots.push(plot);
    new ResizeObserver(() => setWidth(plot, widthIn(box))).observe(box);
  }
  if (data.left_out.length > 0)
    byId("left-out").textContent = "Zero all the time: " + data.left_out.join(", ") + ".";
  byId("reset-zoom").addEventListener("click", zoomOut);

  const redraw = () => plots.forEach((plot) => plot.redraw(false, true));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  // Paper is white whatever the screen is, and no observer sees its width.
  const print = (isOn) => {
    document.documentElement.classList.toggle("printing", isOn);
    for (const plot of plots)
      setWidth(plot, isOn ? paperWidth : widthIn(plot.root.parentElement));
    redraw();
  };
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));
}
