// Fills the page with the data of the run. All texts of the run become text, never HTML.

function showSubtitle(data) {
  const parts = [`Scenario ${data.name}`];
  parts.push(data.started ? `started ${dateText(data.started)}`
    : `written ${dateText(data.written)}`);
  if (data.version) parts.push(`Incise ${data.version}`);
  parts.push(`folder ${data.folder}`);
  byId("subtitle").textContent = parts.join(" · ");
}

function showEnding(ending) {
  const box = byId("ending");
  box.classList.add(ending.kind);
  box.append(element("strong", {}, ending.headline), ending.text);
}

function showFacts(facts) {
  for (const fact of facts) {
    const value = element("dd");
    if (fact.label === "Computing time") {
      value.append(durationText(fact.value));
    } else if (fact.unit === "%") {
      value.append(percentText(fact.value), element("span", { class: "unit" }, "\u00a0%"));
    } else {
      const from = fact.from !== null && fact.from !== fact.value ?
        numberText(fact.from) + " → " : "";
      value.append(from, ...quantity(fact.value, fact.unit));
    }
    byId("facts").append(element("div", { class: "fact" }, element("dt", {}, fact.label), value,
      fact.note ? element("dd", { class: "more" }, fact.note) : ""));
  }
}

function showExpectations(expectations) {
  if (expectations.length === 0) return;
  const rows = expectations.map((line) => element("tr", {},
    element("th", { scope: "row" }, line.quantity),
    element("td", {}, numberText(line.min, 6)), element("td", {}, numberText(line.max, 6)),
    element("td", {}, numberText(line.value, 6)),
    element("td", { class: line.met ? "met" : "missed" }, line.met ? "met" : "missed")));
  const missed = expectations.filter((line) => !line.met).length;
  const missedText = `${missed} of ${counted(expectations.length, "expectation")} missed`;
  if (missed > 0) {
    byId("ending").classList.replace("finished", "failed");
    byId("ending").append(element("strong", {}, missedText + "."));
  }
  byId("expectations").append(
    element("h3", {}, missed === 0 ? "All expectations of the scenario are met"
      : missedText),
    element("div", { class: "scroll" }, element("table", {},
      tableHead(["quantity", "at least", "at most", "is", ""].map((label) => headCell(label, ""))),
      element("tbody", {}, ...rows))));
}

function showWarnings(warnings) {
  if (warnings.length === 0) {
    byId("ending").append(element("span", { class: "quiet" }, "There are no warnings."));
    byId("warnings").hidden = true;
    document.querySelector("nav a[href='#warnings']").hidden = true;
  }
  for (const warning of warnings)
    byId("warning-list").append(element("div", { class: "box warning" }, warning));
}

function showPictures(pictures) {
  const { items } = pictures;
  byId("picture-note").textContent = pictures.note || (items.length === 0 ? "None were asked for."
    : `${items.length} of ${counted(pictures.frames, "frame")}, from one point of view. ` +
      "Click on a picture to enlarge it.");
  const viewer = byId("viewer");
  let current = 0;
  const caption = (item) => `Frame ${item.frame}` +
    (item.time === null ? "" : `, t = ${numberText(item.time, 6)} s`);
  const open = (index) => {
    current = (index + items.length) % items.length;
    byId("viewer-picture").src = items[current].source;
    byId("viewer-picture").alt = caption(items[current]);
    byId("viewer-caption").textContent = caption(items[current]);
    if (!viewer.open) viewer.showModal();
  };
  items.forEach((item, i) => {
    const button = element("button", { type: "button", "aria-label": `Enlarge: ${caption(item)}` },
      element("img", { src: item.source, alt: caption(item), width: "960", height: "720" }));
    button.addEventListener("click", () => open(i));
    byId("picture-list").append(element("figure", {}, button,
      element("figcaption", {}, caption(item))));
  });
  byId("viewer-back").addEventListener("click", () => open(current - 1));
  byId("viewer-next").addEventListener("click", () => open(current + 1));
  byId("viewer-close").addEventListener("click", () => viewer.close());
  viewer.addEventListener("click", (event) => { if (event.target === viewer) viewer.close(); });
  viewer.addEventListener("keydown", (event) => {
    if (event.key === "ArrowLeft") open(current - 1);
    if (event.key === "ArrowRight") open(current + 1);
  });
}

function showAccounts(accounts) {
  for (const account of accounts) {
    const hasAxes = account.rows[0].values.length === 3;
    const heads = hasAxes ? ["x", "y", "z"] : [""];
    const rows = account.rows.map((row) => element("tr", row.result ? { class: "result" } : {},
      element("th", { scope: "row" }, row.label),
      ...row.values.map((value) => element("td", {},
        ...quantity(value, row.unit === account.unit ? "" : row.unit, hasAxes ? 4 : 6)))));
    byId("account-list").append(element("div", { class: "account" },
      element("h3", {}, account.title, element("span", { class: "unit" }, ` in ${account.unit}`)),
      element("div", { class: "scroll" }, element("table", {},
        hasAxes ? tableHead([headCell("", ""), ...heads.map((head) => headCell(head, ""))]) : "",
        element("tbody", {}, ...rows))),
      account.note ? element("p", { class: "note" }, account.note) : ""));
  }
  if (accounts.length === 0)
    byId("account-list").append(element("p", { class: "note" }, "history.csv has no rows."));
}

function showOrigin(data) {
  const { command } = data;
  const box = byId("commands");
  if (command.run) {
    box.append(element("p", {}, "This command made the run" +
      (command.directory ? `, in the folder ${command.directory}:` : ":")),
    element("pre", {}, command.run));
  } else {
    box.append(element("p", {}, "The run has not recorded its command." +
      (command.rerun ? " This one makes the same run in a new folder:" : "")));
    if (command.rerun) box.append(element("pre", {}, command.rerun));
  }
  box.append(element("p", {}, "This command made the page:"),
    element("pre", {}, command.report));
  if (data.scenario === null) {
    byId("scenario").replaceWith(
      element("p", { class: "note" }, `The folder holds no ${data.name}.toml.`));
  } else {
    byId("scenario-text").textContent = data.scenario;
    addEventListener("beforeprint", () => { byId("scenario").open = true; });
  }
  byId("made").textContent =
    `Made by incise report, version ${command.version}, on ${dateText(command.date)}.`;
}

function showPage() {
  const data = JSON.parse(byId("data").textContent);
  showSubtitle(data);
  showEnding(data.ending);
  showFacts(data.facts);
  showExpectations(data.expectations);
  showWarnings(data.warnings);
  showPictures(data.pictures);
  showAccounts(data.accounts);
  showEdits(data.edits);
  showOrigin(data);
  showPlots(data.plots, data.edits.count > 0 ? data.edits.columns[0].values : []);
}

try {
  showPage();
  document.documentElement.dataset.state = "complete";
} catch (error) {
  document.querySelector("main").prepend(
    element("p", { class: "box failed" }, `A part of this page could not be shown: ${error}`));
  throw error;
}
