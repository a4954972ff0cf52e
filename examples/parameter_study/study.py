# What the Snakefile needs beyond rules: combinations with their names and commands, the table of
# the results, and plots of it. Needs matplotlib for the plots (Debian: python3-matplotlib).
# SPDX-License-Identifier: LGPL-3.0-or-later
import collections
import csv
import itertools
import json
import pathlib
import re
import shlex
import subprocess
import tomllib

STATUS = {0: "finished", 1: "expectation failed", 2: "refused", 3: "failed"}
# Entries of summary.json about the run itself: the others are quantities of [expect] too.
OF_THE_RUN = ("title scenario scenario_hash version command directory started threads frames "
              "wall_time steps_per_second real_time_factor").split()
KEYS = "program threads scenario results sweep set quantities plots labels".split()


class StudyError(Exception):
    """A mistake in the configuration."""


def as_toml(value):
    """The value as TOML, for --set. Text stays as it is: `incise` takes plain words."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {as_toml(item)}" for key, item in value.items()) + "}"
    return str(value)


def as_label(value):
    """The value as one word, for tables, legends and names of folders: [8, 4, 8] is 8x4x8."""
    return "x".join(map(as_label, value)) if isinstance(value, list) else as_toml(value)


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return None


def texts_in(value):
    """All texts in the tables and arrays of a scenario."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (dict, list)):
        for item in value.values() if isinstance(value, dict) else value:
            yield from texts_in(item)


class Study:
    def __init__(self, config):
        for key in config:
            if key not in KEYS:
                raise StudyError(f"'{key}' is not known; known: {', '.join(KEYS)}")
        for key in ("scenario", "sweep", "quantities"):
            if not config.get(key):
                raise StudyError(f"'{key}' is missing")
        self.program = str(config.get("program", "incise"))
        self.threads = config.get("threads", 1)
        if not isinstance(self.threads, int) or self.threads < 1:
            raise StudyError(f"threads: is '{self.threads}', but must be a number from 1")
        self.scenario = pathlib.Path(config["scenario"])
        if not self.scenario.is_file():
            raise StudyError(f"scenario: there is no file '{self.scenario}'")
        self.results = pathlib.Path(config.get("results", "results"))
        self.always = config.get("set") or {}
        self.quantities = list(config["quantities"])
        self.labels = config.get("labels") or {}
        self.sweep = config["sweep"]
        for name, parameter in self.sweep.items():
            if set(parameter) != {"key", "values"} or not isinstance(parameter["values"], list):
                raise StudyError(f"sweep.{name} needs a 'key' and a list of 'values'")
        self.parameters = list(self.sweep)
        self.columns = ["run", *self.parameters, "status", *self.quantities, "warnings", "message"]
        if len(set(self.columns)) < len(self.columns):
            raise StudyError(f"two columns have one name: {', '.join(self.columns)}")
        self.table = self.results / "results.csv"
        self.axes = {}  # of each plot
        for plot in config.get("plots") or []:
            for axis in "xy":
                if plot.get(axis) not in self.parameters + self.quantities:
                    raise StudyError(f"plots: {axis} is a parameter or a quantity, not '{plot.get(axis)}'")
            self.axes[self.results / f"{plot['y']}_against_{plot['x']}.png"] = plot["x"], plot["y"]
        self.plots = list(self.axes)
        self.runs = {}  # the values of each
        values = [parameter["values"] for parameter in self.sweep.values()]
        for combination in itertools.product(*values):
            name = self.name(combination)
            if name in self.runs:
                raise StudyError(f"sweep: two combinations have the name '{name}'")
            self.runs[name] = combination
        self.any_run = "|".join(map(re.escape, self.runs))

    def name(self, combination):
        """The name of the folder of a combination: depth_0.03__cells_6x3x6. It has neither = nor a
        comma: Snakemake gives it to jobs of a cluster in a list of NAME=VALUE."""
        parts = (f"{name}_{as_label(value)}" for name, value in zip(self.parameters, combination))
        return re.sub(r"[^\w.+-]", "_", "__".join(parts), flags=re.ASCII)

    def folder(self, run):
        return self.results / "runs" / run

    def settings(self, run):
        """The values that the run has in place of those of the scenario, by their keys."""
        settings = dict(self.always)
        for name, value in zip(self.parameters, self.runs[run]):
            keys = self.sweep[name]["key"]
            for key in [keys] if isinstance(keys, str) else keys:
                settings[key] = value
        return settings

    def words(self, run):
        words = [self.program, "run", str(self.scenario), "--out", str(self.folder(run))]
        for key, value in self.settings(run).items():
            words += ["--set", f"{key}={as_toml(value)}"]
        return words

    def command(self, run):
        return shlex.join(self.words(run))

    def check(self):
        """Asks the program whether it is there and knows the quantities, before anything is run."""
        words = self.words(next(iter(self.runs))) + ["--dry-run", "--force"]
        for quantity in self.quantities:
            if quantity not in OF_THE_RUN:
                words += ["--set", f"expect.{quantity}.max=1e300"]
        try:
            told = subprocess.run(words, capture_output=True, text=True).stderr
        except OSError as error:
            raise StudyError(f"program: '{self.program}' cannot be run: {error.strerror}") from None
        for line in told.splitlines():
            # What else is wrong with this one combination, its own run will say.
            found = re.search(r"key 'expect\.(\S+)': (is not known.*)", line)
            if found and found[1] in self.quantities:
                raise StudyError(f"quantities: '{found[1]}' {found[2]}")

    def inputs(self, run):
        """The scenario, and all files that it names: meshes, surfaces. If one changes, so does the run."""
        scenario = tomllib.loads(self.scenario.read_text())
        files = {self.scenario}
        for text in texts_in([scenario, list(self.settings(run).values())]):
            file = self.scenario.parent / text
            if len(text) < 256 and file.is_file():
                files.add(file)
        return sorted(map(str, files))

    def row(self, run):
        """The row of a run in the table. It has quantities if the run came to its end."""
        folder = self.folder(run)
        status = int((folder / "exit_status").read_text())
        row = {"run": run, "status": STATUS[status]}
        row.update(zip(self.parameters, map(as_label, self.runs[run])))
        if status < 2:
            summary = json.loads((folder / "summary.json").read_text())
            for quantity in self.quantities:
                if quantity not in summary:
                    raise StudyError(f"quantities: '{quantity}' is not known; known: {', '.join(summary)}")
                row[quantity] = summary[quantity]
            row["warnings"] = len(summary["warnings"])
        if status > 0:
            last_try = (folder / "log.txt").read_text().split("\n--- ")[-1].splitlines()
            said = [line for line in last_try if line.startswith("incise: ")]
            row["message"] = "; ".join(x[8:] for x in said if not x.startswith("incise: warning"))
        return row

    def write_table(self, path):
        rows = [self.row(run) for run in self.runs]
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, self.columns, restval="", lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)

    def read_table(self):
        with open(self.table, newline="") as file:
            return list(csv.DictReader(file))

    def verdict(self):
        """What became of the combinations, with the first words of what went wrong."""
        rows = self.read_table()
        counts = collections.Counter(row["status"] for row in rows)
        lines = [f"{self.table}: {len(rows)} combinations: " +
                 ", ".join(f"{counts[word]} {word}" for word in STATUS.values() if counts[word])]
        others = [row for row in rows if row["status"] != "finished"]
        for row in others[:10]:
            lines.append(f"  {row['status']}: {row['run']}: {row['message']:.150}")
        if len(others) > 10:
            lines.append(f"  and {len(others) - 10} more")
        warned = sum(row["warnings"] not in ("", "0") for row in rows)
        if warned:
            lines.append(f"  {warned} with warnings, in their summary.json")
        return "\n".join(lines)

    def label(self, name):
        return self.labels.get(name, name)

    def draw(self, path):
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        x, y = self.axes[path]
        rows = self.read_table()
        others = [name for name in self.parameters if name not in (x, y)]
        lines = {}
        for row in rows:
            name = ", ".join(f"{self.label(other)} {row[other]}" for other in others)
            lines.setdefault(name, []).append(row)
        # Numbers have their places on the axis; anything else stands in its order of the list.
        words = list(dict.fromkeys(row[x] for row in rows if row[x]))
        numbers = {word: as_number(word) for word in words}
        if None in numbers.values():
            numbers = {word: place for place, word in enumerate(words)}
        figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
        colours = plt.get_cmap("viridis")
        for index, (name, line) in enumerate(lines.items()):
            drawn = [row for row in line if row[x] and as_number(row[y]) is not None]
            drawn.sort(key=lambda row: numbers[row[x]])
            colour = colours(0.9 * index / max(1, len(lines) - 1))
            axes.plot([numbers[row[x]] for row in drawn], [float(row[y]) for row in drawn],
                      color=colour, label=name or None)
            for status, face in (("finished", colour), ("expectation failed", "white")):
                some = [row for row in drawn if row["status"] == status]
                axes.plot([numbers[row[x]] for row in some], [float(row[y]) for row in some],
                          "o", color=colour, markerfacecolor=face)
        if words and None in map(as_number, words):
            axes.set_xticks(range(len(words)), words)
        notes = []
        unmet = sum(row["status"] == "expectation failed" for row in rows)
        if unmet:
            notes.append(f"hollow: an expectation failed ({unmet})")
        if not any(as_number(row[y]) is not None for row in rows):
            axes.set(xticks=[], yticks=[])
        missing = sum(as_number(row[y]) is None for row in rows)
        if missing:
            notes.append(f"not drawn: {missing} of {len(rows)} combinations, which did not finish")
        axes.set_title("\n".join(notes), fontsize="small")
        axes.set_xlabel(self.label(x))
        axes.set_ylabel(self.label(y))
        axes.grid(alpha=0.3)
        if others:
            axes.legend(fontsize="small")
        figure.savefig(path, dpi=100)
        plt.close(figure)
