#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""Contact beside analytic answers: docs/validation.md, part "Contact".

Runs the tests that have such answers, prints the results that they record beside them, and draws
docs/validation_contact.png. Usage, about three minutes:

    data/validation/contact_plots.py build/release
"""

import argparse
import json
import math
import pathlib
import subprocess
import tempfile

from plots import COLOURS, HERE, plt, row, save

SUITES = ("ContactCollisions", "ContactFriction", "ContactPatch", "ContactPressure")
CURVE = "curve "
FRICTION = 0.4  # of the block on a slope
SLOPE = 0.1  # of the wedge


def records(folder):
    """What the tests record, in their order: by name, a result and its answer."""
    found = {}
    for program in ("sim_tests", "sim_long_tests"):
        with tempfile.TemporaryDirectory() as temporary:
            path = pathlib.Path(temporary) / "results.json"
            command = [folder / program, f"--gtest_filter={':'.join(f'{s}.*' for s in SUITES)}"]
            command += [f"--gtest_output=json:{path}"]
            if subprocess.run(command, stdout=subprocess.DEVNULL).returncode != 0:
                raise SystemExit(f"{program}: a test failed")
            for suite in json.loads(path.read_text())["testsuites"]:
                for test in suite["testsuite"]:
                    for name, value in test.items():
                        words = value.split() if isinstance(value, str) else ()
                        if name[0] == "C" or name.startswith(CURVE):
                            found[name] = tuple(float(word) for word in words)
    return found


def print_table(results):
    for name in sorted(results, key=lambda text: (int(text[1:].split()[0]), text)):
        result, answer = results[name]
        is_ratio = answer != 0 and math.isfinite(answer)
        error = f"{result / answer - 1:+.1e}" if is_ratio else ""
        row(name, f"{answer:g}", f"{result:.6g}", error)


def curve(results, name):
    """The points of a curve, in ascending order."""
    start = f"{CURVE}{name} at "
    return zip(*sorted(value for key, value in results.items() if key.startswith(start)))


def draw(results, folder):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13, 4.2))

    def mark(axes, name, colour, shape, label, scale=1.0):
        x, y = curve(results, name)
        x = [scale * value for value in x]
        look = {"color": COLOURS[colour], "fillstyle": "none", "markeredgewidth": 1.5}
        axes.plot(x, y, shape, markersize=8, label=label, **look)

    depth, force = curve(results, "sphere hertz")
    left.loglog([1e3 * d for d in depth], force, "-", color="black", label="Hertz", linewidth=1)
    mark(left, "sphere force", 0, "o", "Incise", 1e3)
    left.set(title="Rigid sphere on a slab", xlabel="depth (mm)", ylabel="force (N)")

    frictions = [0.01 * i for i in range(36)]
    forces = [(SLOPE + mu) / (1 - SLOPE * mu) for mu in frictions]
    label = r"$(\tan\alpha + \mu)/(1 - \mu\,\tan\alpha)$"
    middle.plot(frictions, forces, "-", color="black", label=label, linewidth=1)
    mark(middle, "wedge rigid", 0, "o", "Incise, rigid wedge")
    mark(middle, "wedge cut", 1, "s", "Incise, cut from one body")
    middle.set(title="Block pushed up a slope of 0.1", xlabel="friction", ylabel="force / weight")

    slopes = [0.01 * i for i in range(106)]
    angles = [math.atan(slope) for slope in slopes]
    for mu, style in ((FRICTION, "-"), (0.0, "--")):
        slides = [max(0.0, math.sin(a) - mu * math.cos(a)) for a in angles]
        label = rf"$\max(0, \sin\alpha - \mu\,\cos\alpha)$, $\mu$ = {mu:g}"
        right.plot(slopes, slides, style, color="black", label=label, linewidth=1)
    mark(right, "incline friction 0.4", 0, "o", f"Incise, {FRICTION:g}")
    mark(right, "incline friction 0", 1, "s", "Incise, 0")
    right.set(title="Block on a slope", xlabel=r"slope, $\tan\alpha$")
    right.set(ylabel="acceleration / gravity")
    for axes in (left, middle, right):
        axes.grid(True, color="0.9")
        axes.legend(fontsize=8)
    save(figure, folder, "contact")


def main():
    parser = argparse.ArgumentParser(
        description="Draws docs/validation_contact.png and prints results beside their answers."
    )
    parser.add_argument("build", type=pathlib.Path, help="folder of the build, e.g. build/release")
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=HERE.parents[1] / "docs",
        help="folder of the picture (default: docs)",
    )
    arguments = parser.parse_args()
    results = records(arguments.build.resolve())
    print_table({name: value for name, value in results.items() if name[0] == "C"})
    draw(results, arguments.out)


if __name__ == "__main__":
    main()
