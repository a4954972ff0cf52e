#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-3.0-or-later
"""HEML beside analysis and other finite element codes: docs/validation.md, part "HEML".

Draws docs/validation_uniaxial.png and _equilibria.png and prints the tables. Usage:

    data/validation/heml_plots.py build/release/incise
"""

import argparse
import base64
import csv
import json
import math
import pathlib
import struct
import subprocess
import tempfile
import xml.etree.ElementTree as xml

from plots import COLOURS, HERE, plt, row, save

REFERENCES = HERE.parent / "references"
LAWS = {  # by their names in the references; what the scenario calls them
    "stvk": "saint-venant-kirchhoff",
    "nh26": "neo-hookean",
    "mr_ln": "mooney-rivlin",
    "fd_ln": "fung-demiray",
    "ciarlet": "neo-hookean-ciarlet",
    "nh_iso": "neo-hookean-isochoric",
    "mr_iso": "mooney-rivlin-isochoric",
    "fd_iso": "fung-demiray-isochoric",
    "ogden": "ogden",
}
PAPER = 0.0022  # HEML 2015, section 5.2: the worst of three nodes


def load(name):
    return json.loads((REFERENCES / f"{name}.json").read_text())


def material(law, parameters):
    """The section [[material]] for a law of the references, whose lambda is the constant of the law
    and not always Lame's at rest."""
    p = parameters
    keys = {
        "stvk": lambda: {"lame_lambda": p["lam"], "lame_mu": p["mu"]},
        "nh26": lambda: {"lame_lambda": p["lam"], "lame_mu": p["mu"]},
        "ciarlet": lambda: {"lame_lambda": p["lam"], "lame_mu": p["mu"]},
        "mr_ln": lambda: {"c1": p["C1"], "c2": p["C2"], "lame_lambda": p["lam"] + 4 * p["C2"]},
        "fd_ln": lambda: {
            "gamma": p["g"],
            "lame_lambda": p["lam"] + 2 * p["mu"] * p["g"],
            "lame_mu": p["mu"],
        },
        "nh_iso": lambda: {"c1": p["C1"], "bulk_modulus": p["K"]},
        "mr_iso": lambda: {"c1": p["C1"], "c2": p["C2"], "bulk_modulus": p["K"]},
        "fd_iso": lambda: {"gamma": p["g"], "shear_modulus": p["mu"], "bulk_modulus": p["K"]},
        "ogden": lambda: {"bulk_modulus": p["K"]},
    }[law]()
    words = [f"law='{LAWS[law]}'", "density=1000"]
    words += [f"{key}={value!r}" for key, value in keys.items()]
    if law == "ogden":
        terms = (f"{{mu={p[f'mu{i}']!r}, alpha={p[f'alpha{i}']!r}}}" for i in (1, 2))
        words.append(f"terms=[{', '.join(terms)}]")
    return "{" + ", ".join(words) + "}"


class Run:
    """A finished run: its history, its summary, and its last frame by node of the mesh file."""

    def __init__(self, incise, scenario, *settings):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            command = [incise, "run", scenario, "--quiet", "--out", folder]
            command += [word for setting in settings for word in ("--set", setting)]
            finished = subprocess.run(command, capture_output=True, text=True)
            if finished.returncode > 1:  # expectations are those of the scenario as it stands
                raise SystemExit(f"{scenario} {settings}: {finished.stderr}")
            with open(folder / "history.csv") as file:
                self.history = [
                    {key: float(value) for key, value in line.items()}
                    for line in csv.DictReader(file)
                ]
            self.summary = json.loads((folder / "summary.json").read_text())
            frames = sorted(folder.glob("frames/*.vtu"))
            self.frame = xml.parse(frames[-1])

    def array(self, path, form):
        data = base64.b64decode(self.frame.find(f".//{path}").text.strip())[8:]
        return [number for (number,) in struct.iter_unpack(form, data)]

    def nodes(self):
        """Rest and current position of each node, by its number."""
        ids = self.array("PointData/DataArray[@Name='node_id']", "<q")
        rest = self.array("PointData/DataArray[@Name='rest_position']", "<d")
        now = self.array("Points/DataArray", "<d")
        return {n: (rest[3 * i : 3 * i + 3], now[3 * i : 3 * i + 3]) for i, n in enumerate(ids)}


# Uniaxial tension and compression: HEML 2015, section 5.1 and figure 6.


def uniaxial_curve(incise, law):
    """Stretch, stress and volume ratio where both scenarios come to rest."""
    points = {}
    for scenario, change, rest, num_steps in (
        ("uniaxial_compression", -0.05, 4, 8),
        ("uniaxial_tension", 0.05, 1, 12),
    ):
        setting = material(law["name"], law["params"])
        run = Run(incise, HERE / f"{scenario}.toml", f"material[0]={setting}")
        for line in run.history[1:]:
            stretch = round(1 + change * min(round(line["time"] / rest), num_steps), 6)
            points[stretch] = (line["reaction_top_z"] / 0.01, line["min_J"])
    return [(stretch, *points[stretch]) for stretch in sorted(points)]


def draw_uniaxial(incise, folder):
    print("\nuniaxial: largest differences from analysis, of stress over Young's modulus and of J\n")
    figure, (stresses, volumes) = plt.subplots(1, 2, figsize=(11, 4.8))
    for i, (name, law) in enumerate(load("uniaxial")["data"].items()):
        law["name"] = name
        rows = law["rows"]
        table = {round(stretch, 6): (stress, J) for stretch, stress, _, J in rows}
        points = uniaxial_curve(incise, law)
        line = {"color": plt.cm.tab10(i), "linewidth": 1}
        stresses.plot([r[0] for r in rows], [r[1] / 1e3 for r in rows], **line)
        volumes.plot([r[0] for r in rows], [r[3] for r in rows], **line)
        x = [point[0] for point in points]
        dots = {"marker": "osv^D<>Px"[i], "linestyle": "none", "markersize": 5, "fillstyle": "none"}
        dots |= {"color": plt.cm.tab10(i), "label": LAWS[name]}
        stresses.plot(x, [point[1] / 1e3 for point in points], **dots)
        volumes.plot(x, [point[2] for point in points], **dots)
        young = law["rest_moduli"]["E"]
        of_stress = max(abs(P - table[stretch][0]) / young for stretch, P, _ in points)
        of_volume = max(abs(J - table[stretch][1]) for stretch, _, J in points)
        row(LAWS[name], f"{of_stress:.1e}", f"{of_volume:.1e}")
    stresses.set(title="Uniaxial stress, E = 10 kPa, ν = 0.3", xlabel="stretch")
    stresses.set(ylabel="force over area at rest (kPa)")
    volumes.set(title="Volume", xlabel="stretch", ylabel="volume over that at rest")
    stresses.plot([], [], color="black", linewidth=1, label="analytic (lines)")
    stresses.legend(fontsize=8)
    for axes in (stresses, volumes):
        axes.grid(True, color="0.9")
    save(figure, folder, "uniaxial")


# Equilibria of organ and notched blocks: HEML 2015, section 5.2.


def write_mesh(path, points, tetrahedra):
    """A legacy VTK file: nodes have the numbers of the reference."""
    lines = ["# vtk DataFile Version 3.0", "reference", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines.append(f"POINTS {len(points)} double")
    lines += [" ".join(repr(c) for c in point) for point in points]
    lines.append(f"CELLS {len(tetrahedra)} {5 * len(tetrahedra)}")
    lines += ["4 " + " ".join(map(str, corners)) for corners in tetrahedra]
    lines.append(f"CELL_TYPES {len(tetrahedra)}")
    path.write_text("\n".join(lines + ["10"] * len(tetrahedra)) + "\n")


SCENARIO = """[mesh]
file = "mesh.vtk"
[[material]]
density = 1000
[dynamics]
end_time = {end}
damping = {damping}
[[constraint]]
name = "held"
where = {{ nodes = {held} }}
fix = "xyz"
[[constraint]]
name = "moved"
where = {{ nodes = {moved} }}
move = [{{ time = 0, by = [0, 0, 0] }}, {{ time = 0.2, by = {by} }}]
[output]
interval = {end}
compression = "none"
fields = []
"""


def equilibrium(incise, points, tetrahedra, held, moved, by, setting, end, damping):
    """Displacements by node and the force on the moved nodes."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_mesh(folder / "mesh.vtk", points, tetrahedra)
        text = SCENARIO.format(held=held, moved=moved, by=by, end=end, damping=damping)
        (folder / "case.toml").write_text(text)
        run = Run(incise, folder / "case.toml", f"material[0]={setting}")
    moves = {
        node: [x - X for x, X in zip(now, rest)] for node, (rest, now) in run.nodes().items()
    }
    reaction = [run.history[-1][f"reaction_moved_{c}"] for c in "xyz"]
    return moves, reaction


def differences(moves, reference, reaction, expected):
    """Over the largest displacement; of single nodes over their own; of the force."""
    largest = max(math.hypot(*u) for u in reference)
    gaps = [math.dist(moves[n], u) for n, u in enumerate(reference)]
    # Nodes that hardly move have no relative error worth the name.
    sizes = [math.hypot(*u) for u in reference]
    single = [gap / size for gap, size in zip(gaps, sizes) if size > 0.01 * largest]
    force = max(abs(a - b) for a, b in zip(reaction, expected) if b is not None)
    size = math.hypot(*(a for a in expected if a is not None))
    return max(gaps) / largest, max(single), force / size


def organ_cases():
    organ = load("organ_ellipsoid")
    for name, result in organ["results"].items():
        state, law = name.split("/")
        cut = state == "cut"
        origin = organ["origin"] if cut else range(len(organ["nodes"]))

        def copies(nodes):
            wanted = set(nodes)
            return [n for n, source in enumerate(origin) if source in wanted]

        setting = material(law, result["params"])
        yield (
            f"organ, {'cut' if cut else 'whole'}",
            law,
            result,
            (
                organ["cut_nodes" if cut else "nodes"],
                organ["cut_tets" if cut else "tets"],
                copies(organ["fixed"]),
                copies(organ["moved"]),
                organ["disp"],
                setting,
                3,
                60,
            ),
            result["reaction_on_moved_set"],
        )


def notch_cases():
    for i, block in enumerate(load("notch_p1_exact")):
        height = block["L"][2]
        nodes = block["cut_nodes"]
        ends = [[n for n, X in enumerate(nodes) if abs(X[2] - z) < 1e-9] for z in (0, height)]
        for law, result in block["results"].items():
            setting = material(law, result["params"])
            by = [0, 0, block["d"] * height]
            yield (
                f"block notched to {1000 * block['a']:g} mm",
                law,
                result,
                (nodes, block["cut_tets"], *ends, by, setting, 3, 60),
                [None, None, result["Fz_top"]],
            )


def draw_equilibria(incise, folder):
    print("\nequilibria: differences from finite elements on the same mesh\n")
    cases = []
    for body, law, result, arguments, expected in (*organ_cases(), *notch_cases()):
        moves, reaction = equilibrium(incise, *arguments)
        found = differences(moves, result["u"], reaction, expected)
        calculix = result.get("calculix_C3D4_max_rel_diff")
        texts = [f"{value:.1e}" for value in found]
        row(body, LAWS[law], *texts, f"{calculix:.1e}" if calculix else "")
        cases.append((f"{body}, {LAWS[law]}", *found[:2], calculix))
    figure, axes = plt.subplots(figsize=(10, 0.28 * len(cases) + 1.4))
    places = range(len(cases), 0, -1)
    for mark, colour, label, values in (
        ("o", 0, "displacements, over the largest", [case[1] for case in cases]),
        ("|", 1, "worst single node, over its own", [case[2] for case in cases]),
        ("x", 3, "CalculiX, which prints seven digits", [case[3] for case in cases]),
    ):
        axes.plot(values, places, mark, color=COLOURS[colour], label=label, fillstyle="none")
    axes.axvline(PAPER, color="black", lw=1)
    axes.text(PAPER, len(cases) + 0.6, "HEML 2015: 0.22 % ", ha="right", fontsize=8)
    axes.set(xscale="log", xlim=(1e-13, 1e-2))
    axes.set(xlabel="relative difference from linear finite elements")
    axes.set_ylim(0.3, len(cases) + 1.4)
    axes.set_yticks(list(places), [case[0] for case in cases], fontsize=8)
    axes.grid(True, axis="x", color="0.9")
    axes.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1, 0.02))
    save(figure, folder, "equilibria")


# A block notched by a blade, against the converged solution.


def opening(run):
    """Between the lips at the mouth, at the side of the block, along z: of copies of a node."""
    heights = {}
    for rest, now in run.nodes().values():
        if abs(rest[0]) < 1e-9 and abs(rest[1]) < 1e-9:
            heights.setdefault(rest[2], []).append(now[2])
    return max(max(z) - min(z) for z in heights.values())


def print_notch(incise):
    print("\nnotch: bricks along x; force and opening over the converged ones, by default and exact\n")
    ours = load("notch_converged")["rows"][0]["nh26_tet10"]
    for n in (5, 9, 13, 17, 25):
        found = []
        for snap in ("0.015", "0"):
            run = Run(
                incise,
                HERE / "notch.toml",
                f"mesh.box.cells=[{n}, {(n + 1) // 3}, {n}]",
                f"tool.0.snap={snap}",
                "output.compression=none",
                "output.fields=[]",
            )
            found.append(run.history[-1]["reaction_top_z"] / ours["Fz"] - 1)
            found.append(opening(run) / ours["COD_mouth_surface"] - 1)
        row(str(n), *(f"{100 * value:+.2f} %" for value in found))


def main():
    parser = argparse.ArgumentParser(
        description="Draws the pictures and prints the tables of docs/validation.md on HEML."
    )
    parser.add_argument("incise", help="the program, e.g. build/release/incise")
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=HERE.parents[1] / "docs",
        help="folder of the pictures (default: docs)",
    )
    arguments = parser.parse_args()
    draw_uniaxial(arguments.incise, arguments.out)
    draw_equilibria(arguments.incise, arguments.out)
    print_notch(arguments.incise)


if __name__ == "__main__":
    main()
