"""A run through Python gives the bits of a run without it."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import json
import os
import pathlib
import subprocess
import tempfile
import tomllib
import unittest

import numpy as np

import incise
import support


def run_by_frames(body: incise.World) -> None:
    """Run a scenario to its end with the steps of the program: evenly to each frame."""
    assert body.end_time is not None
    frame = 1
    while frame * body.output_interval < body.end_time - 1e-9 * body.output_interval:
        body.run_until(frame * body.output_interval)
        frame += 1
    body.run_until(body.end_time)


class SameBits(unittest.TestCase):
    def end_of_reference(self, scenario: pathlib.Path) -> tuple[np.ndarray, np.ndarray, int, int]:
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "state"
            text = subprocess.run([os.environ["INCISE_REFERENCE"], "run", scenario, out],
                                  check=True, capture_output=True, text=True).stdout
            values = np.fromfile(out).reshape(2, -1, 3)
        steps, edits = map(int, text.split())
        return values[0], values[1], steps, edits

    def compare(self, name: str) -> None:
        path = support.SCENARIOS / name
        positions, velocities, steps, edits = self.end_of_reference(path)
        body = incise.World(path)
        run_by_frames(body)
        self.assertEqual((body.num_steps, len(body.edits())), (steps, edits))
        np.testing.assert_array_equal(body.positions, positions)
        np.testing.assert_array_equal(body.velocities, velocities)

    def test_blade_on_its_path(self) -> None:
        self.compare("beam.toml")

    def test_statics(self) -> None:
        self.compare("notch_static.toml")

    def test_dict_gives_the_bits_of_the_file(self) -> None:
        path = support.SCENARIOS / "beam.toml"
        with open(path, "rb") as file:
            scenario = tomllib.load(file)
        scenario.pop("expect")
        file_world, dict_world = incise.World(path), incise.World(scenario)
        sections = incise.World(mesh=scenario["mesh"], materials=scenario["material"],
                                constraints=scenario["constraint"], tools=scenario["tool"],
                                dynamics={"end_time": 0.3}, gravity=[0, 0, -9.81], damping=2)
        for body in (file_world, dict_world, sections):
            body.run_until(0.1)
        self.assertTrue(file_world.edits())
        for body in (dict_world, sections):
            np.testing.assert_array_equal(body.positions, file_world.positions)
            np.testing.assert_array_equal(body.velocities, file_world.velocities)
            self.assertEqual(body.edits(), file_world.edits())

    @unittest.skipUnless(os.access(os.environ.get("INCISE_PROGRAM", ""), os.X_OK),
                         "the program is not built")
    def test_edits_and_ledger_are_those_of_the_program(self) -> None:
        path = support.SCENARIOS / "beam.toml"
        body = incise.World(path)
        run_by_frames(body)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["INCISE_PROGRAM"], "run", path, "--out", folder, "--quiet"],
                           check=True, capture_output=True)
            lines = (pathlib.Path(folder) / "edits.jsonl").read_text().splitlines()
            summary = json.loads((pathlib.Path(folder) / "summary.json").read_text())
        self.assertEqual(body.edits(), [json.loads(line) for line in lines])
        for name, value in body.ledger().items():
            self.assertEqual(summary[name], value, name)


if __name__ == "__main__":
    unittest.main()
