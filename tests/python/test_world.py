"""Worlds, their arrays and what steps report."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import pathlib
import tempfile
import unittest
import warnings
from typing import Any

import numpy as np

import incise
import support


FACES = {
    "tetrahedron": [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]],
    "hexahedron": [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1],
                   [4, 5, 6, 7]],
    "pyramid": [[0, 3, 2, 1], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]}


def in_a_row(arrays: Any) -> np.ndarray:
    """Return what a body says of its elements, a dict by kind in a mixed mesh, as one array."""
    return np.concatenate(list(arrays.values())) if isinstance(arrays, dict) else arrays


def faces_of(cells: Any) -> list[list[list[int]]]:
    """Return the faces of each cell, as lists of rows, in the order of the arrays of cells."""
    if not isinstance(cells, dict):
        cells = {"tetrahedron" if cells.shape[1] == 4 else "hexahedron": cells}
    found = []
    for kind, values in cells.items():
        if kind == "polyhedron":
            numbers = iter(values.tolist())
            found += [[[next(numbers) for _ in range(next(numbers))] for _ in range(num_faces)]
                      for num_faces in numbers]
        else:
            found += [[[row[i] for i in face] for face in FACES[kind]] for row in values.tolist()]
    return found


class Arrays(unittest.TestCase):
    def test_shapes_and_types(self) -> None:
        body = support.world()
        n = body.num_nodes
        for name in ("positions", "velocities", "rest_positions", "contact_forces"):
            array = getattr(body, name)
            self.assertEqual((array.shape, array.dtype), ((n, 3), np.float64), name)
        self.assertEqual((body.masses.shape, body.masses.dtype), ((n,), np.float64))
        self.assertEqual(body.cells.shape, (144, 4))
        self.assertEqual(body.regions.tolist(), [0] * 144)
        self.assertEqual(body.node_ids.shape, (n,))
        self.assertAlmostEqual(body.masses.sum(), 1000 * 0.12 * 0.04 * 0.04)

    def test_copies_survive_edits(self) -> None:
        body = support.world()
        positions, cells, surface = body.positions, body.cells, body.surface
        kept = positions.copy(), cells.copy(), surface.triangles.copy()
        support.cut_through(body)
        self.assertGreater(body.num_nodes, len(positions))
        np.testing.assert_array_equal(positions, kept[0])
        np.testing.assert_array_equal(cells, kept[1])
        np.testing.assert_array_equal(surface.triangles, kept[2])
        positions[:] = 0.0  # a copy may be changed
        self.assertGreater(np.abs(body.positions).max(), 0.0)

    def test_hexahedra_have_eight_corners(self) -> None:
        body = support.hex_world()
        self.assertEqual(body.cells.shape, (24, 8))
        self.assertEqual(body.surface.triangles.shape[0], 2 * (2 * 4 + 4 * 12))

    def test_rows_stay_consistent_when_nodes_die(self) -> None:
        body = support.world()
        burr = body.add_tool("burr", {"kind": "carver", "shape": {"sphere": {"radius": 0.03}}},
                             incise.Pose([0.12, 0.02, 0.02]))
        burr.pose = incise.Pose([0.119, 0.02, 0.02])
        before = body.num_nodes
        report = body.step()
        self.assertTrue(report.edits)
        self.assertLess(body.num_nodes, before)
        rows = np.unique(body.cells)
        np.testing.assert_array_equal(rows, np.arange(body.num_nodes))
        rest = body.rest_positions
        corners = rest[body.cells]
        volumes = np.einsum("ij,ij->i", np.cross(corners[:, 1] - corners[:, 0],
                                                 corners[:, 2] - corners[:, 0]),
                            corners[:, 3] - corners[:, 0]) / 6
        self.assertGreater(volumes.min(), 0.0)
        self.assertAlmostEqual(1000 * volumes.sum(), body.masses.sum())
        self.assertLess(body.surface.triangles.max(), body.num_nodes)
        with body.view() as view:
            np.testing.assert_array_equal(view.positions, body.positions)
            np.testing.assert_array_equal(view.rest_positions, rest)
        clamped = np.flatnonzero(rest[:, 0] == 0.0)
        np.testing.assert_array_equal(body.positions[clamped], rest[clamped])

    def test_surface_is_closed_and_follows_edits(self) -> None:
        body = support.world()
        first = body.surface
        self.assertIs(body.surface, first)
        self.assertFalse(first.is_cut.any())
        version = body.topology_version
        support.cut_through(body)
        surface = body.surface
        self.assertNotEqual(body.topology_version, version)
        self.assertEqual(surface.version, body.topology_version)
        self.assertTrue(surface.is_cut.any())
        np.testing.assert_array_equal(np.unique(surface.triangles), surface.vertices)
        edges = np.concatenate([surface.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])
        there = {tuple(edge) for edge in edges.tolist()}
        self.assertTrue(all((b, a) in there for a, b in there))
        with self.assertRaises(ValueError):
            surface.triangles[0, 0] = 1

    def test_faces_of_cuts_are_those_inside_the_box(self) -> None:
        for snap in (0.0, 0.05):
            for run in (lambda w: w.step(dt=1e-5), lambda w: w.run_until(0.02)):
                body = support.world(mesh=support.box((10, 4, 3)))
                knife = body.add_tool("knife", {"kind": "blade", "snap": snap,
                                                "edge": [[0, 0, -0.01], [0, 0, 0.05]]},
                                      pose=incise.Pose([-0.003, 0.021, 0]))
                knife.pose = incise.Pose([0.083, 0.0225, 0])
                knife.withdraw()
                run(body)
                corners = body.rest_positions[body.surface.triangles]
                on_box = [(abs(corners[:, :, axis] - value) < 1e-12).all(axis=1)
                          for axis, size in enumerate((0.12, 0.04, 0.04)) for value in (0, size)]
                np.testing.assert_array_equal(body.surface.is_cut, ~np.any(on_box, axis=0))
                self.assertTrue(body.surface.is_cut.any())
                other = support.world(mesh=support.box((1, 1, 1)))
                other.restore(body.save())
                self.assertEqual(other.surface.is_cut.sum(), body.surface.is_cut.sum())
                with tempfile.TemporaryDirectory() as folder:
                    body.write_vtu(folder + "/frame.vtu")
                    other = support.world(mesh=folder + "/frame.vtu")
                self.assertEqual(other.surface.is_cut.sum(), body.surface.is_cut.sum())

    def test_physics_has_the_momentum_of_the_ledger(self) -> None:
        for law in ("stable-neo-hookean", "saint-venant-kirchhoff"):
            body = support.world(materials=[{**support.MATERIAL, "law": law}],
                                 gravity=[1.0, 0, -9.81])
            for x in (None, 0.05, 0.0713):
                if x is None:
                    body.run_until(0.01)
                else:
                    support.cut_through(body, x)
                nodes = body.physics
                momentum = nodes.masses @ nodes.velocities
                energy = 0.5 * nodes.masses @ (nodes.velocities ** 2).sum(axis=1)
                ledger = body.ledger()
                np.testing.assert_allclose(
                    momentum, [ledger["momentum_" + axis] for axis in "xyz"],
                    rtol=0, atol=1e-12 * np.linalg.norm(momentum))
                self.assertAlmostEqual(energy, ledger["kinetic_energy"], delta=1e-12 * energy)
                self.assertAlmostEqual(nodes.masses.sum(), ledger["mass"], delta=1e-12)
                fragments = in_a_row(nodes.fragments)
                self.assertEqual(fragments.shape, (body.num_cells,))
                self.assertEqual(set(fragments), set(range(len(nodes.cells))))
                self.assertEqual(set(nodes.cells.ravel()), set(range(len(nodes.masses))))
            self.assertGreater(body.num_cells, len(nodes.cells))
            with self.assertRaises(ValueError):
                nodes.masses[0] = 1.0

    def test_volume_shares_are_those_of_the_material(self) -> None:
        body = support.world()
        np.testing.assert_array_equal(body.physics.volume_shares, 1.0)
        support.cut_through(body, 0.0713)
        nodes = body.physics
        whole = nodes.rest_positions[nodes.cells]
        edges = whole[:, 1:] - whole[:, :1]
        carried = nodes.volume_shares * np.abs(np.linalg.det(edges)) / 6
        volumes = np.bincount(in_a_row(nodes.fragments), body.elements.volumes)
        np.testing.assert_allclose(carried, volumes, rtol=1e-9)
        self.assertTrue((nodes.volume_shares < 1.0).any())

    def test_elements_are_in_the_order_of_cells_of_all_kinds(self) -> None:
        brick = incise.Mesh.box([0.12, 0.04, 0.04], [1, 1, 1], "hex")
        roof = incise.Mesh(np.vstack([brick.points, [[0.06, 0.02, 0.06]]]),
                           {"hexahedron": brick.cells, "pyramid": [[4, 5, 7, 6, 8]]},
                           regions={"hexahedron": [1], "pyramid": [2]})
        for name, mesh, cut_at in (("tetrahedra", support.box(), 0.0713),
                                   ("hexahedra", support.box(element="hex"), 0.0713),
                                   ("two kinds", roof, 0.0713), ("a long way off", roof, 0.2)):
            with self.subTest(name):
                body = support.world(mesh=mesh)
                first = body.elements
                self.assertIs(body.elements, first)
                support.cut_through(body, cut_at)
                elements, rest = body.elements, body.rest_positions
                self.assertEqual(elements.version, body.topology_version)
                self.assertEqual(isinstance(body.cells, dict) and "polyhedron" in body.cells,
                                 name not in ("tetrahedra", "a long way off"))
                np.testing.assert_array_equal(elements.regions, in_a_row(body.regions))
                self.assertEqual(len(elements.regions), body.num_cells)
                for faces, centre, volume in zip(faces_of(body.cells), elements.centres,
                                                 elements.volumes):
                    corners = np.unique(np.concatenate(faces))
                    np.testing.assert_allclose(rest[corners].mean(axis=0), centre, rtol=1e-12)
                    # The sum of the tetrahedra between the origin and triangles round each face.
                    sum_of_parts = 0.0
                    for face in faces:
                        x = rest[face]
                        sum_of_parts += np.cross(x, np.roll(x, -1, axis=0)).sum(
                            axis=0) @ x.mean(axis=0) / 6
                    self.assertAlmostEqual(sum_of_parts, volume, delta=1e-12 * volume + 1e-18)
                with self.assertRaises(ValueError):
                    elements.volumes[0] = 1.0

    def test_components_are_those_of_the_ledger(self) -> None:
        burr = {"kind": "carver", "shape": {"box": {"size": [0.022, 0.1, 0.1]}}}
        for mesh in (support.box(), support.box(element="hex")):
            body = support.world(mesh=mesh)
            self.assertFalse(body.components.any() or body.elements.components.any())
            for change in (lambda: support.cut_through(body, 0.0913),
                           lambda: support.cut_through(body, 0.0713),
                           lambda: body.add_tool("burr", burr, incise.Pose([0.03, 0.02, 0.02]))):
                change()
                body.step()
                components = body.components
                self.assertIs(body.components, components)
                self.assertEqual(components.shape, (body.num_nodes,))
                for faces, component in zip(faces_of(body.cells), body.elements.components):
                    self.assertEqual(set(components[np.concatenate(faces)]), {component})
                self.assertEqual(set(components), set(range(int(body.ledger()["components"]))))
                # They are ranges of x here.
                x = body.rest_positions[:, 0]
                ends = sorted((x[components == c].min(), x[components == c].max())
                              for c in set(components))
                for (_, end), (start, _) in zip(ends, ends[1:]):
                    self.assertLessEqual(end, start + 1e-9)
            self.assertEqual(len(ends), 4)

    def test_bodies_of_polyhedra_only(self) -> None:
        for corners, kind in ((5, "pyramid"), (8, "hexahedron")):
            points = 0.04 * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0],
                                      [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
            mesh = incise.Mesh(points[:corners],
                               {kind: [list(range(corners))]}, regions={kind: [3]})
            body = support.world(mesh=mesh, constraints=[])
            for cut in (mesh, body):
                self.assertEqual(cut.cells.tolist(), [list(range(corners))])
            support.cut_through(body, 0.012)
            mesh = incise.cut(mesh, planes=[([0.012, 0, 0], [1, 0, 0])]).mesh
            for cut in (mesh, body):
                self.assertEqual((cut.num_cells, len(faces_of(cut.cells))), (2, 2))
                self.assertEqual({k: v.tolist() for k, v in cut.regions.items()},
                                 {"polyhedron": [3, 3]})
            self.assertEqual(body.stress["polyhedron"].shape, (2, 3, 3))
            self.assertEqual(body.volume_ratio["polyhedron"].shape, (2,))
            self.assertEqual(set(in_a_row(body.physics.fragments)), {0, 1})

    def test_stress_and_volume_ratio_are_those_of_the_strain(self) -> None:
        """Of a block that is drawn out, against the law in each tetrahedron."""
        young, poisson, factor = 1e4, 0.4, 1.02
        lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        shear = young / (2 * (1 + poisson))
        body = support.world()
        np.testing.assert_allclose(body.stress, 0.0, atol=1e-9 * young)
        np.testing.assert_allclose(body.volume_ratio, 1.0, rtol=1e-12)
        stretched = support.world(
            materials=[{**support.MATERIAL, "law": "saint-venant-kirchhoff"}],
            damping=None, dynamics={"mode": "static"}, constraints=[
                support.CLAMP,
                {"name": "end", "where": {"box": {"min": [0.119, -1, -1], "max": [1, 1, 1]}},
                 "move": [{"time": 0, "by": [0, 0, 0]},
                          {"time": 1, "by": [0.12 * (factor - 1), 0, 0]}]}])
        stretched.run_until(1.0)
        stress, ratio = stretched.stress, stretched.volume_ratio
        self.assertEqual(stress.shape, (stretched.num_cells, 3, 3))
        np.testing.assert_allclose(stress, stress.transpose(0, 2, 1), atol=1e-9 * young)
        # From the deformation gradient of each tetrahedron.
        rest, now = stretched.rest_positions[stretched.cells], stretched.positions[stretched.cells]
        gradient = (np.linalg.inv(rest[:, 1:] - rest[:, :1]) @ (now[:, 1:] - now[:, :1]))
        gradient = gradient.transpose(0, 2, 1)
        det = np.linalg.det(gradient)
        np.testing.assert_allclose(ratio, det, rtol=1e-10)
        strain = 0.5 * (gradient.transpose(0, 2, 1) @ gradient - np.eye(3))
        second = lame * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3) \
            + 2 * shear * strain
        cauchy = gradient @ second @ gradient.transpose(0, 2, 1) / det[:, None, None]
        np.testing.assert_allclose(stress, cauchy, atol=1e-9 * young)
        mixed = support.world(mesh=incise.Mesh(
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1],
             [3, 0, 0], [4, 0, 0], [3, 1, 0], [3, 0, 1]],
            {"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]], "tetrahedron": [[8, 9, 10, 11]]},
            {"hexahedron": [1], "tetrahedron": [0]}),
            materials=[{**support.MATERIAL, "regions": [0]},
                       {**support.HEX_MATERIAL, "regions": [1]}], constraints=[])
        self.assertEqual({kind: rows.shape for kind, rows in mixed.stress.items()},
                         {"tetrahedron": (1, 3, 3), "hexahedron": (1, 3, 3)})
        self.assertEqual({kind: rows.tolist() for kind, rows in mixed.physics.volume_shares.items()},
                         {"tetrahedron": [1.0], "hexahedron": [1.0]})

    def test_physics_counts_fragments_through_all_kinds(self) -> None:
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                  [0, 1, 1], [3, 0, 0], [4, 0, 0], [3, 1, 0], [3, 0, 1]]
        mesh = incise.Mesh(points, {"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
                                    "tetrahedron": [[8, 9, 10, 11]]},
                           {"hexahedron": [1], "tetrahedron": [0]})
        body = support.world(mesh=mesh, materials=[{**support.MATERIAL, "regions": [0]},
                                                   {**support.HEX_MATERIAL, "regions": [1]}])
        for kind, cells in body.cells.items():
            np.testing.assert_array_equal(
                body.physics.rest_positions[body.physics.cells[kind]], body.rest_positions[cells])
        self.assertEqual({kind: rows.tolist() for kind, rows in body.physics.fragments.items()},
                         {"tetrahedron": [0], "hexahedron": [1]})

    def test_cells_whose_quadrilaterals_meet_triangles_keep_their_kind(self) -> None:
        points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1],
                  [0, 1, 1], [0.5, 0.5, 2]]
        mesh = incise.Mesh(points, {"hexahedron": [[0, 1, 2, 3, 4, 5, 6, 7]],
                                    "tetrahedron": [[4, 5, 6, 8], [4, 6, 7, 8]]})
        body = support.world(mesh=mesh, materials=[support.MATERIAL], constraints=[])
        self.assertEqual(body.num_nodes, 9)
        self.assertEqual({kind: len(rows) for kind, rows in body.cells.items()},
                         {"tetrahedron": 2, "hexahedron": 1})
        np.testing.assert_array_equal(body.rest_positions[body.cells["hexahedron"][0]], points[:8])
        self.assertEqual({kind: rows.shape for kind, rows in body.stress.items()},
                         {"tetrahedron": (2, 3, 3), "hexahedron": (1, 3, 3)})

    def test_triangles_face_outwards(self) -> None:
        body = support.world()
        corners = body.rest_positions[body.surface.triangles]
        areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        volume = np.einsum("ij,ij->", corners.mean(axis=1), areas) / 3
        self.assertAlmostEqual(volume, 0.12 * 0.04 * 0.04)


class Steps(unittest.TestCase):
    def test_step_advances_by_safety_times_the_stable_step(self) -> None:
        body = support.world(dynamics={"safety": 0.5, "damping": 5}, damping=None)
        bound = body.stable_step
        report = body.step()
        self.assertEqual((report.start, report.end, report.num_steps), (0.0, 0.5 * bound, 1))
        self.assertEqual(body.time, 0.5 * bound)
        report = body.step(dt=1e-5, n=7)
        self.assertEqual(report.num_steps, 7)
        self.assertEqual(body.num_steps, 8)

    def test_run_until_ends_exactly(self) -> None:
        body = support.world()
        report = body.run_until(0.0123)
        self.assertEqual(body.time, 0.0123)
        self.assertEqual(report.num_steps, body.num_steps)
        self.assertEqual(body.run_until(0.0123).num_steps, 0)

    def test_fixed_step_of_the_scenario_is_taken(self) -> None:
        body = support.world(dynamics={"time_step": 1e-4})
        self.assertEqual(body.step().end, 1e-4)

    def test_edits_have_the_names_of_the_file(self) -> None:
        body = support.world()
        report = support.cut_through(body)
        self.assertEqual(report.edits, body.edits())
        edit = report.edits[0]
        for key in ("time", "step", "tool", "elements_split", "cut_area", "before", "after"):
            self.assertIn(key, edit)
        self.assertEqual(edit["tool"], "knife_0")
        self.assertEqual(report.edits[-1]["after"]["components"], 2)

    def test_ledger_has_the_names_of_the_history(self) -> None:
        body = support.world(gravity=[0, 0, -9.81])
        body.run_until(0.01)
        ledger = body.ledger()
        self.assertEqual(ledger["time"], 0.01)
        self.assertAlmostEqual(ledger["mass"], 0.192)
        self.assertIn("reaction_clamp_z", ledger)
        self.assertEqual(ledger["mass_error"], 0.0)

    def test_implicit_and_static_worlds_step(self) -> None:
        off = {"contact": {"enabled": False}, "damping": None}
        implicit = support.world(dynamics={"integrator": "implicit-euler", "time_step": 0.01},
                                 gravity=[0, 0, -1], **off)
        self.assertEqual(implicit.run_until(0.05).num_steps, 5)
        static = support.world(dynamics={"mode": "static"}, gravity=[0, 0, -1], **off)
        static.step()
        self.assertEqual(static.time, 1.0)
        self.assertLess(static.positions[:, 2].min(), 0.0)

    def test_numbers_of_threads_give_the_same_bits(self) -> None:
        one, two = support.world(gravity=[0, 0, -9]), support.world(gravity=[0, 0, -9])
        two.num_threads = 2
        self.assertEqual((one.num_threads, two.num_threads), (1, 2))
        one.run_until(0.01)
        two.run_until(0.01)
        np.testing.assert_array_equal(one.positions, two.positions)


class Definitions(unittest.TestCase):
    def test_mesh_may_be_a_dict_a_file_or_a_mesh(self) -> None:
        mesh = incise.Mesh.box([0.12, 0.04, 0.04], [6, 2, 2])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "block.vtk"
            mesh.write(path)
            worlds = [support.world(mesh=source)
                      for source in (support.box(), mesh, path, str(path), {"file": path},
                                     incise.read_mesh(path))]
        for body in worlds:
            body.run_until(0.002)
            self.assertEqual(body.num_cells, 144)
            np.testing.assert_array_equal(body.positions, worlds[0].positions)

    def test_whole_scenario_may_be_a_dict(self) -> None:
        body = incise.World({"title": "a block", "mesh": support.box(),
                             "material": [support.MATERIAL],
                             "constraint": [support.CLAMP],
                             "dynamics": {"end_time": 0.5, "gravity": np.array([0, 0, -1.0])}})
        self.assertEqual((body.end_time, body.name), (0.5, "world"))
        self.assertIsNone(support.world().end_time)
        mesh = incise.Mesh.box([1, 1, 1], [1, 1, 1], "hex")
        body = incise.World({"mesh": mesh, "material": [support.HEX_MATERIAL]})
        self.assertEqual(body.num_cells, 1)

    def test_regions_of_a_mesh_choose_materials(self) -> None:
        block = incise.Mesh.box([1, 1, 1], [1, 1, 1])
        mesh = incise.Mesh(block.points, block.cells, regions=[1, 1, 1, 2, 2, 2])
        body = incise.World(mesh=mesh, materials=[
            {**support.MATERIAL, "regions": [1]},
            {**support.MATERIAL, "regions": [2], "density": 3000}])
        self.assertAlmostEqual(body.masses.sum(), 2000.0)
        self.assertEqual(sorted(body.regions.tolist()), [1, 1, 1, 2, 2, 2])

    def test_overrides_change_values(self) -> None:
        body = incise.World(support.SCENARIOS / "beam.toml", overrides=["dynamics.end_time=0.25"])
        self.assertEqual((body.end_time, body.name), (0.25, "beam"))
        self.assertEqual(body.output_interval, 0.01)

    def test_warnings_of_runs_are_given_while_stepping(self) -> None:
        """A probe that begins in the tissue is told of once, at the call in which it overlaps."""
        body = support.world()
        ball = body.add_tool("ball", {"kind": "probe", "shape": {"sphere": {"radius": 0.01}}})
        ball.place(incise.Pose([0.06, 0.02, 0.04]))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            body.step()
            body.step(n=3)
        self.assertEqual(len(caught), 1)
        self.assertIn("surfaces overlapped by up to", str(caught[0].message))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            other = support.world()
            other.restore(body.save())
            other.step(n=3)  # the bytes say that it was told

    def test_world_without_end_warns_of_no_late_times(self) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for dynamics in ({}, {"mode": "static"}):
                support.world(dynamics=dynamics, damping=None, loads=[
                    {"name": "pull", "where": {"box": {"min": [0.11, -1, -1], "max": [1, 1, 1]}},
                     "nodal_force": [1e-3, 0, 0],
                     "factor": [{"time": 0, "value": 0}, {"time": 2e6, "value": 1}]}])

    def test_warnings_reach_python(self) -> None:
        far = {"kind": "blade", "edge": [[0, 0, 0], [0, 1, 0]],
               "path": [{"time": 0, "at": [9, 0, 0]}, {"time": 1, "at": [9, 0, -1]}]}
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            body = support.world(tools=[far])
        self.assertEqual([w.category for w in caught], [incise.InciseWarning])
        self.assertIn("touches nothing where the body rests", str(caught[0].message))
        self.assertEqual(len(body.warnings), 1)

    def test_loads_have_factors(self) -> None:
        top = {"box": {"min": [0.119, -1, -1], "max": [1, 1, 1]}}
        body = support.world(loads=[{"name": "pull", "where": top, "nodal_force": [0, 0, 1e-3]}])
        self.assertEqual(body.loads["pull"].factor, 1.0)
        body.loads["pull"].factor = 0.0
        body.run_until(0.01)
        self.assertLess(np.abs(body.velocities).max(), 1e-12)
        body.loads["pull"].factor = 2.0
        body.run_until(0.02)
        self.assertEqual(body.loads["pull"].factor, 2.0)
        self.assertGreater(body.velocities[:, 2].max(), 0.0)

    def test_frame_reads_back_as_the_body(self) -> None:
        body = support.world()
        support.cut_through(body)
        with tempfile.TemporaryDirectory() as folder:
            body.write_vtu(pathlib.Path(folder) / "frame.vtu")
            mesh = incise.read_mesh(pathlib.Path(folder) / "frame.vtu")
        self.assertEqual(mesh.num_cells, body.num_cells)
        np.testing.assert_array_equal(mesh.points, body.rest_positions)


if __name__ == "__main__":
    unittest.main()
