// The table of edits: sorted, of one tool or all, and as many rows as are asked for.

const rowsAtOnce = 100;

/** Returns a head of a table. */
function tableHead(cells) {
  return element("thead", {}, element("tr", {}, ...cells));
}

function headCell(label, unit, meaning = "", attributes = {}) {
  return element("th", { scope: "col", title: meaning, ...attributes }, label,
    unit ? element("span", { class: "unit" }, ` ${unit}`) : "");
}

/** What each tool did in all. */
function showTools(tools) {
  if (tools.length === 0) return;
  const heads = [["tool", ""], ["edits", ""], ["first", "s"], ["last", "s"], ["crossed", ""],
    ["removed", ""], ["cut area", "m²"], ["mass removed", "kg"]];
  const rows = tools.map((tool) => element("tr", {}, element("th", { scope: "row" }, tool.tool),
    ...tool.values.map((value) => element("td", {}, numberText(value)))));
  byId("tool-table").append(element("table", {},
    tableHead(heads.map(([label, unit]) => headCell(label, unit))),
    element("tbody", {}, ...rows)));
}

/** Draws the table of edits into the page. */
function showEdits(data) {
  if (data.count === 0) {
    byId("edit-note").textContent = "No tool has changed the mesh.";
    return;
  }
  byId("edit-note").textContent =
    "An edit is what one tool did to the mesh in one step. Δ is the body after the edit less the " +
    "body before it. Click on a column to sort." +
    (data.shown < data.count ?
      ` The page has the first ${numberText(data.shown)} of ${numberText(data.count)} edits; ` +
      "edits.jsonl has all." : "");
  showTools(data.tools);

  const state = { column: 0, isDescending: false, tool: -1, limit: rowsAtOnce };
  // A column with the same zero everywhere says nothing; beside the table there is no room for it.
  const columns = data.columns.filter((column) => column.values.some((value) => value !== 0));
  const hidden = data.columns.filter((column) => !columns.includes(column));
  const body = element("tbody");
  const heads = columns.map((column, i) => {
    const button = element("button", { type: "button" }, column.label,
      column.unit ? element("span", { class: "unit" }, ` ${column.unit}`) : "");
    button.addEventListener("click", () => {
      state.isDescending = state.column === i ? !state.isDescending : i > 1;
      state.column = i;
      draw();
    });
    return element("th", { scope: "col", title: column.meaning }, button);
  });
  heads.splice(2, 0, headCell("tool", "", "", { class: "text" }));
  byId("edit-table").append(element("table", {}, tableHead(heads), body));
  if (hidden.length > 0)
    byId("edit-note").textContent +=
      " Zero in all edits: " + hidden.map((column) => column.label).join(", ") + ".";

  /** The numbers of the edits that are wanted, in order. */
  function order() {
    const rows = [];
    for (let i = 0; i < data.shown; ++i)
      if (state.tool < 0 || data.tool_column[i] === state.tool) rows.push(i);
    const values = columns[state.column].values;
    const sign = state.isDescending ? -1 : 1;
    // What has no value comes last.
    return rows.sort((a, b) => {
      if (values[a] === null || values[b] === null)
        return (values[a] === null) - (values[b] === null) || a - b;
      return sign * (values[a] - values[b]) || a - b;
    });
  }

  function draw() {
    const rows = order();
    body.replaceChildren(...rows.slice(0, state.limit).map((i) => {
      const cells = columns.map((column) => element("td", {}, numberText(column.values[i])));
      cells.splice(2, 0,
        element("td", { class: "text" }, data.tools[data.tool_column[i]].tool));
      return element("tr", {}, ...cells);
    }));
    heads.filter((head) => head.querySelector("button")).forEach((head, i) => {
      if (i === state.column)
        head.setAttribute("aria-sort", state.isDescending ? "descending" : "ascending");
      else
        head.removeAttribute("aria-sort");
    });
    const shown = Math.min(rows.length, state.limit);
    const more = byId("edit-more");
    more.replaceChildren(`${numberText(shown)} of ${counted(rows.length, "edit")} shown. `);
    for (const step of [rowsAtOnce, 1000]) {
      if (shown >= rows.length) break;
      const button = element("button", { type: "button" }, `Show ${numberText(step)} more`);
      button.addEventListener("click", () => { state.limit += step; draw(); });
      more.append(button, " ");
    }
  }

  if (data.tools.length > 1) {
    const select = element("select", { id: "edit-tool" }, element("option", { value: "-1" }, "all"),
      ...data.tools.map((tool, i) => element("option", { value: String(i) }, tool.tool)));
    select.addEventListener("change", () => { state.tool = Number(select.value); draw(); });
    byId("edit-controls").append(element("label", { for: "edit-tool" }, "Edits of tool"), select);
  }
  draw();
}
