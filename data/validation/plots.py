#!/usr/bin/env python3
# Runs the scenarios of this folder, and sweeps of them, and draws docs/validation_*.png; prints the
# tables of docs/validation.md. Needs matplotlib (Debian: python3-matplotlib).
#   data/validation/plots.py build/release/incise
# SPDX-License-Identifier: LGPL-3.0-or-later
import argparse
import base64
import json
import math
import pathlib
import struct
import subprocess
import tempfile
import xml.etree.ElementTree as xml

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
REFERENCES = json.loads((HERE / "references.json").read_text())
WITH_ALL = "material[0].stiffness_ratio=1"
WITHOUT_INNER = "material[0].stiffness_ratio=inf"
WITHOUT_FACE = "material[0].face_diagonals=false"
# For Poisson's ratio 0: the right kappa, springs with 2/5 E for G; see docs/validation.md.
E_FORM = (
    "material[0]={method='hybmss', density=1000, "
    "shear_modulus=4000, bulk_modulus=1666.6666666666667}"
)
MESHES = (  # of HybMSS 2020, Table 6
    (10, 10, 10),
    (15, 15, 15),
    (20, 20, 20),
    (30, 30, 30),
    (4, 4, 24),
    (8, 8, 48),
    (10, 10, 60),
    (16, 16, 96),
)
COLOURS = ("#0b5394", "#cc4125", "#38761d", "#7f6000", "#741b47")

# What an experiment measures, and the key that says how far it goes.
EXPERIMENTS = {
    "compression": (
        "compression_20",
        "volume_change",
        lambda x: f"constraint[1].move[1].by=[0, 0, {-5 * x}]",
    ),
    "tension": (
        "tension_20",
        "volume_change",
        lambda x: f"constraint[1].move[1].by=[0, 0, {2.4 * x}]",
    ),
    "shear": (
        "shear_20",
        "reaction_top_x",
        lambda x: f"constraint[1].move[1].by=[{5 * x}, 0, 0]",
    ),
    "torsion": (
        "torsion_45",
        "torque_top_z",
        lambda x: f"constraint[1].rotate[1].angle={math.radians(x)}",
    ),
}


def run(incise, scenario, *settings):
    """The summary of a run, and its last frame if it wrote frames; None if the run failed.

    Expectations are those of the scenario as it stands, so they are not looked at here."""
    with tempfile.TemporaryDirectory() as folder:
        command = [incise, "run", HERE / f"{scenario}.toml", "--quiet", "--out", folder]
        command += [word for setting in settings for word in ("--set", setting)]
        finished = subprocess.run(command, capture_output=True, text=True)
        if finished.returncode == 3:
            return None, None
        if finished.returncode > 1:
            raise SystemExit(f"{scenario} {settings}: {finished.stderr}")
        summary = json.loads((pathlib.Path(folder) / "summary.json").read_text())
        frames = sorted(pathlib.Path(folder).glob("frames/*.vtu"))
        return summary, read_frame(frames[-1]) if frames else None


def read_frame(path):
    """Rest positions and displacements of a frame that is written with compression = "none"."""
    formats = {"Float32": "<f", "Float64": "<d"}
    arrays = []
    for name in ("rest_position", "displacement"):
        array = xml.parse(path).find(f".//PointData/DataArray[@Name='{name}']")
        data = base64.b64decode(array.text.strip())[8:]  # after the number of bytes
        numbers = [number for (number,) in struct.iter_unpack(formats[array.get("type")], data)]
        arrays.append([numbers[i : i + 3] for i in range(0, len(numbers), 3)])
    return arrays


def sweep(incise, experiment, points, *settings):
    scenario, quantity, setting = EXPERIMENTS[experiment]
    values = []
    for point in points:
        summary, _ = run(incise, scenario, "output.interval=0", setting(point), *settings)
        values.append(summary[quantity] if summary else math.nan)
    return values


def row(*cells):
    print("| " + " | ".join(cells) + " |")


def refinement_table(incise):
    """The cube with 5, 10 and 20 cells along each edge."""
    print("\nrefinement\n")
    for experiment in ("compression", "shear", "torsion"):
        for deformation in REFERENCES[experiment]["deformation"]:
            cells = [f"mesh.box.cells=[{n}, {n}, {n}]" for n in (5, 10, 20)]
            values = [sweep(incise, experiment, [deformation], setting)[0] for setting in cells]
            row(experiment, f"{deformation:g}", *(f"{value:.5g}" for value in values))


def plate_force_table(incise):
    """Shear: the force along the shift, along the height, and its size (the paper's, it seems)."""
    print("\nshear: parts and size of the plate's force\n")
    for way in (WITH_ALL, WITHOUT_FACE):
        for deformation in REFERENCES["shear"]["deformation"]:
            scenario, _, setting = EXPERIMENTS["shear"]
            summary, _ = run(incise, scenario, setting(deformation), way)
            along, up = summary["reaction_top_x"], summary["reaction_top_z"]
            forces = (along, up, math.hypot(along, up))
            row(way, f"{deformation:g}", *(f"{force:,.0f}" for force in forces))


def experiment_tables(incise):
    """Ours with A = 1, without inner diagonals and without face diagonals, and the references."""
    for experiment in EXPERIMENTS:
        reference = REFERENCES[experiment]
        calculix = reference["calculix"]
        deformations = reference["deformation"]
        ways = (WITH_ALL, WITHOUT_INNER, WITHOUT_FACE)
        ours = [sweep(incise, experiment, deformations, way) for way in ways]
        is_volume = EXPERIMENTS[experiment][1] == "volume_change"

        def text(value, digits=3):
            return f"{100 * value:.{digits}f} %" if is_volume else f"{value:,.0f}"

        print(f"\n{experiment}\n")
        for i, deformation in enumerate(deformations):
            row(
                f"{deformation:g}",
                text(reference["paper_fem"][i], 2),
                text(calculix["neo_hookean"][i], 2),
                text(calculix["saint_venant_kirchhoff"][i], 2),
                text(reference["paper_hybmss"][i], 2),
                text(ours[0][i]),
                text(ours[1][i]),
                text(reference["paper_hybmss_fd"][i], 2),
                text(ours[2][i]),
            )
            gap = abs(ours[0][i]) / reference["paper_hybmss"][i] - 1
            error = ours[0][i] / reference["equilibrium"][i] - 1
            print(f"    from the paper's HybMSS {gap:+.2%}, from the equilibrium {error:+.1e}")


def poisson_table(incise):
    """Volume changes at other Poisson's ratios."""
    print("\nother Poisson's ratios\n")
    for name, setting in (
        ("0", "material[0].poisson=0"),
        ("0, E form", E_FORM),
        ("0.499", "material[0].poisson=0.499"),
    ):
        for experiment in ("compression", "tension"):
            values = sweep(incise, experiment, (0.05, 0.2), setting)
            texts = ("fails" if math.isnan(value) else f"{100 * value:.3f} %" for value in values)
            row(name, experiment, *texts)


def draw_experiment(axes, incise, experiment, points, scale, unit):
    """What is measured over the deformation: the differences would not show beside its growth."""
    reference = REFERENCES[experiment]

    def secants(values, deformations):
        return [abs(scale * v / d) for v, d in zip(values, deformations)]

    for label, style, colour, setting in (
        ("Incise, A = 1", "-", COLOURS[0], WITH_ALL),
        ("Incise, A = inf", "--", COLOURS[0], WITHOUT_INNER),
    ):
        values = secants(sweep(incise, experiment, points, setting), points)
        axes.plot([unit * p for p in points], values, style, color=colour, label=label)
    calculix = reference["calculix"]
    at = reference["deformation"]
    for label, mark, colour, fill, values in (
        ("paper, HybMSS", "o", 1, "full", reference["paper_hybmss"]),
        ("paper, FEM", "s", 2, "none", reference["paper_fem"]),
        ("CalculiX, neo-Hookean", "^", 3, "none", calculix["neo_hookean"]),
        ("CalculiX, St Venant-Kirchhoff", "v", 4, "none", calculix["saint_venant_kirchhoff"]),
    ):
        look = {"color": COLOURS[colour], "fillstyle": fill, "markersize": 8}
        look |= {"label": label, "markeredgewidth": 1.5}
        axes.plot([unit * d for d in at], secants(values, at), mark, **look)
    axes.set_xlim(0, None)
    axes.grid(True, color="0.9")


def save(figure, folder, name):
    figure.tight_layout()
    path = folder / f"validation_{name}.png"
    figure.savefig(path, dpi=90)
    plt.close(figure)
    print(f"\n{path.name}: {path.stat().st_size / 1e3:.0f} kB")


def draw_volume(incise, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2))
    points = [0.005] + [0.0125 * i for i in range(1, 17)]
    draw_experiment(left, incise, "compression", points, 1, 100)
    draw_experiment(right, incise, "tension", points, 1, 100)
    left.set(title="Compression of the cube", xlabel="shortening (%)")
    left.set(ylabel="loss of volume (%) / shortening (%)")
    right.set(title="Tension of the beam", xlabel="lengthening (%)")
    right.set(ylabel="gain of volume (%) / lengthening (%)")
    left.legend(fontsize=8)
    save(figure, folder, "volume")


def draw_forces(incise, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2))
    shifts = [0.005] + [0.0125 * i for i in range(1, 17)]
    angles = [1] + [2.5 * i for i in range(1, 19)]
    draw_experiment(left, incise, "shear", shifts, 0.01, 100)
    draw_experiment(right, incise, "torsion", angles, 1, 1)
    left.set(title="Shear of the cube", xlabel="shift over height (%)")
    left.set(ylabel="force (N) / shift over height (%)")
    right.set(title="Torsion of the cube", xlabel="angle (degrees)")
    right.set(ylabel="torque (N m) / angle (degrees)")
    left.legend(fontsize=8)
    save(figure, folder, "forces")


def centre_line(frame):
    """Current (z, y) of the nodes of the beam's axis, from root to tip; y is 0 at rest."""
    rest, displacement = frame
    nodes = [
        (X[2], X[2] + u[2], u[1])
        for X, u in zip(rest, displacement)
        if abs(X[0] - 0.2) < 1e-6 and abs(X[1] - 0.2) < 1e-6
    ]
    return [(z, y) for _, z, y in sorted(nodes)]


def euler_bernoulli(z, density, young, g=10.0, side=0.4, length=2.4):
    """HybMSS 2020, eq. (6.1), with the size of gravity."""
    inertia = side**4 / 12
    shape = 4 * length * z**3 - 6 * length**2 * z**2 - z**4
    return density * g * side**2 / (24 * young * inertia) * shape


def draw_beams(incise, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2))
    # The last frame alone, as read_frame reads it.
    frames = ("output.interval=100", "output.compression=none", 'output.fields=["displacement"]')
    heavy = (
        "material[0].density=1000",
        "material[0].young=2e6",
        "dynamics.damping=6",
        "dynamics.end_time=8",
    )
    print("\nbeams: drop of the centre of the end face, m\n")

    def bend(label, scenario, *settings):
        summary, frame = run(incise, scenario, *frames, *settings)
        line = centre_line(frame)
        farthest = summary["max_displacement"]
        print(f"    {label}: {-line[-1][1]:.5f}; farthest node {farthest:.5f}")
        return line

    def draw(axes, style, colour, label, scenario, *settings):
        z, y = zip(*bend(label, scenario, *settings))
        axes.plot(z, y, style, color=COLOURS[colour], label=f"Incise {label}", markersize=4)

    def draw_linear(axes, density, young, label=None):
        z = [2.4 * i / 48 for i in range(49)]
        y = [euler_bernoulli(at, density, young) for at in z]
        axes.plot(z, y, "--", color="black", label=label, linewidth=1, zorder=3)

    def draw_calculix(axes, case, label=None):
        z, y = 2.4 + case["calculix_z"], -case["calculix"]
        look = {"color": COLOURS[3], "markersize": 10, "fillstyle": "none", "zorder": 4}
        axes.plot([z], [y], "*", label=label, **look)

    firm, soft_and_light, soft = REFERENCES["beam"]
    draw_linear(left, 1000, 10e6, "Euler-Bernoulli, (6.1)")
    draw_calculix(left, firm, "CalculiX, end")
    draw(left, "o-", 0, "4 x 4 x 24", "beam_10MPa")
    draw(left, "-", 1, "8 x 8 x 48", "beam_10MPa_fine")
    bend("4 x 4 x 24, A = inf", "beam_10MPa", WITHOUT_INNER)
    bend("8 x 8 x 48, A = inf", "beam_10MPa_fine", WITHOUT_INNER)
    draw_linear(right, 100, 2e6, "Euler-Bernoulli, (6.1)")
    draw_linear(right, 1000, 2e6)
    draw_calculix(right, soft_and_light, "CalculiX, end")
    draw_calculix(right, soft)
    draw(right, "o-", 0, "4 x 4 x 24, 100 kg/m³", "beam_2MPa")
    draw(right, "s-", 1, "4 x 4 x 24, 1000 kg/m³", "beam_10MPa", *heavy)
    bend("4 x 4 x 24, 100 kg/m³, A = inf", "beam_2MPa", WITHOUT_INNER)
    bend("4 x 4 x 24, 1000 kg/m³, A = inf", "beam_10MPa", WITHOUT_INNER, *heavy)
    left.set(title="Beam under its weight: 10 MPa, 1000 kg/m³")
    right.set(title="Beam under its weight: 2 MPa")
    for axes in (left, right):
        axes.set(xlabel="z (m)", ylabel="deflection (m)")
        axes.grid(True, color="0.9")
        axes.legend(fontsize=8)
        axes.set_xlim(0, 2.5)
    save(figure, folder, "beam")


def spring_table():
    """Cells, nodes; springs without face diagonals, with shared ones, with 12 a cell; shares."""
    print("\nsprings\n")
    for x, y, z in MESHES:
        cells = x * y * z
        nodes = (x + 1) * (y + 1) * (z + 1)
        edges = x * (y + 1) * (z + 1) + (x + 1) * y * (z + 1) + (x + 1) * (y + 1) * z
        faces = (x + 1) * y * z + x * (y + 1) * z + x * y * (z + 1)
        without = edges + 4 * cells
        counts = (cells, nodes, without, without + 2 * faces, without + 12 * cells, 28 * cells)
        row(f"{x} × {y} × {z}", *(f"{count:,}" for count in counts))


def main():
    parser = argparse.ArgumentParser(
        description="Draws docs/validation_*.png and prints the tables of docs/validation.md."
    )
    parser.add_argument("incise", help="the program, e.g. build/release/incise")
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=HERE.parents[1] / "docs",
        help="folder of the pictures (default: docs)",
    )
    arguments = parser.parse_args()
    experiment_tables(arguments.incise)
    plate_force_table(arguments.incise)
    poisson_table(arguments.incise)
    refinement_table(arguments.incise)
    draw_volume(arguments.incise, arguments.out)
    draw_forces(arguments.incise, arguments.out)
    draw_beams(arguments.incise, arguments.out)
    spring_table()


if __name__ == "__main__":
    main()
