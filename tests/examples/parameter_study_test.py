#!/usr/bin/env python3
# Kills a small study of examples/parameter_study in the middle of a run, lets it go on, and checks
# the table. Ends with status 77, for skipped, where Snakemake or matplotlib is missing.
#   tests/examples/parameter_study_test.py build/release/incise
# SPDX-License-Identifier: LGPL-3.0-or-later
import csv
import importlib.util
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = ROOT / "data/scenarios/beam.toml"
# With 1e9 m/s2 the first step goes too far: status 3. The stiffer beam springs back too far: status 1.
YOUNG = [50000, 100000]
GRAVITY = [[0, 0, -9.81], [0, 0, -(10**9)]]
SETTINGS = {
    "mesh.box.cells": [40, 8, 8],
    "dynamics.end_time": 0.1,
    "output.checkpoint_interval": 0.005,
    "tool[0].path[1].time": 0.1,
    "expect": {"max_displacement": {"max": 0.052}},
}
CONFIG = {
    "scenario": str(SCENARIO),
    "sweep": {
        "young": {"key": "material[0].young", "values": YOUNG},
        "gravity": {"key": "dynamics.gravity", "values": GRAVITY},
    },
    "set": SETTINGS,
    "quantities": ["max_displacement", "cut_area"],
    "plots": [{"x": "young", "y": "max_displacement"}],
}
STATUS = {
    ("50000", "0x0x-9.81"): "finished",
    ("100000", "0x0x-9.81"): "expectation failed",
    ("50000", "0x0x-1000000000"): "failed",
    ("100000", "0x0x-1000000000"): "failed",
}


def run_in_progress(study):
    """The folder of a run that has taken a checkpoint after its first and has not ended."""
    for folder in study.glob("results/runs/*"):
        checkpoints = list(folder.glob("checkpoints/step_*.checkpoint"))
        begun = any(int(file.stem.split("_")[1]) > 0 for file in checkpoints)
        if begun and not (folder / "summary.json").exists():
            return folder
    return None


def kill_in_the_middle(command, study):
    process = subprocess.Popen(command, cwd=study, start_new_session=True)
    until = time.monotonic() + 60
    while not (folder := run_in_progress(study)):
        assert process.poll() is None, "the study ended before it could be killed"
        assert time.monotonic() < until, "no run took a checkpoint"
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    assert not (folder / "exit_status").exists()
    return folder


def check_table(study):
    with open(study / "results/results.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {(row["young"], row["gravity"]): row["status"] for row in rows} == STATUS, rows
    for row in rows:
        summary = json.loads((study / "results/runs" / row["run"] / "summary.json").read_text())
        came_to_its_end = row["status"] != "failed"
        for quantity in CONFIG["quantities"]:
            assert row[quantity] == (str(summary[quantity]) if came_to_its_end else ""), row
        assert bool(row["message"]) == (row["status"] != "finished"), row


def check_bytes(folder, program, study):
    """The run that was killed has the history of one that was not."""
    kept = next(folder.glob("*.toml"))
    subprocess.run([program, "run", kept, "--out", study / "whole", "--quiet"],
                   stdout=subprocess.DEVNULL)
    assert (folder / "history.csv").read_bytes() == (study / "whole/history.csv").read_bytes()


def check_replacement(command, study, config):
    """Runs with another value replace those that are there and cannot be resumed with it."""
    shorter = SETTINGS | {"dynamics.end_time": 0.02}
    (study / "config.yaml").write_text(json.dumps(config | {"set": shorter}))
    subprocess.run(command, cwd=study, check=True)
    with open(study / "results/results.csv", newline="") as file:
        statuses = [row["status"] for row in csv.DictReader(file)]
    assert sorted(statuses) == ["failed", "failed", "finished", "finished"], statuses
    for run in study.glob("results/runs/*0x0x-9.81"):
        assert json.loads((run / "summary.json").read_text())["time"] == 0.02


def check_mistakes(command, study, config):
    """A mistake in config.yaml is told before anything is run."""
    right = {"program": config["program"], "quantities": config["quantities"]}
    for wrong, cause in (({"quantities": ["max_displacment"]}, "did you mean 'max_displacement'?"),
                         ({"program": "no_such_program"}, "cannot be run"),
                         ({"threads": "many"}, "must be a number from 1")):
        plots = [] if "quantities" in wrong else config["plots"]
        changed = config | {"results": "other"} | right | wrong | {"plots": plots}
        (study / "config.yaml").write_text(json.dumps(changed))
        done = subprocess.run(command, cwd=study, capture_output=True, text=True)
        assert done.returncode != 0 and cause in done.stderr, done.stderr
        assert not list(study.glob("other/runs/*/log.txt"))


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    if not shutil.which("snakemake") or not importlib.util.find_spec("matplotlib"):
        print("skipped: needs snakemake and python3-matplotlib")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        study = pathlib.Path(folder) / "study"
        shutil.copytree(ROOT / "examples/parameter_study", study,
                        ignore=shutil.ignore_patterns("results", ".snakemake", "__pycache__"))
        # JSON is YAML.
        config = CONFIG | {"program": str(program)}
        command = ["snakemake", "--profile", "profiles/local", "--cores", "1"]
        check_mistakes(command, study, config)
        (study / "config.yaml").write_text(json.dumps(config))
        killed = kill_in_the_middle(command, study)
        subprocess.run([*command, "--unlock"], cwd=study, check=True)
        subprocess.run(command, cwd=study, check=True)
        assert "goes on at t" in (killed / "log.txt").read_text()
        check_table(study)
        check_bytes(killed, program, study)
        assert (study / "results/max_displacement_against_young.png").stat().st_size > 0
        again = subprocess.run(command, cwd=study, check=True, capture_output=True, text=True)
        assert "Nothing to be done" in again.stderr, again.stderr
        check_replacement(command, study, config)


main()
