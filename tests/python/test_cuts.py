"""Meshes, and cuts without dynamics."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import pathlib
import tempfile
import unittest
import warnings

import numpy as np

import incise
import support


class Meshes(unittest.TestCase):
    def test_arrays_make_the_mesh_of_a_box(self) -> None:
        box = incise.Mesh.box([0.2, 0.1, 0.1], [4, 2, 2], origin=[1, 0, 0])
        mesh = incise.Mesh(box.points, box.cells.astype(np.int32))
        self.assertEqual((mesh.num_points, mesh.num_cells), (45, 96))
        self.assertAlmostEqual(mesh.volume, 0.002)
        self.assertAlmostEqual(mesh.surface_area, 0.1)
        np.testing.assert_allclose(mesh.bounding_box, [[1, 0, 0], [1.2, 0.1, 0.1]])
        self.assertEqual(mesh.regions.tolist(), [0] * 96)
        self.assertGreater(mesh.quality["min_altitude"], 0.0)

    def test_mixed_cells_are_a_dict(self) -> None:
        hexes = incise.Mesh.box([1, 1, 1], [1, 1, 1], "hex")
        points = np.vstack([hexes.points, [[0.5, 0.5, 2.0]]])
        apex = [*hexes.cells[0][4:8], 8]
        mesh = incise.Mesh(points, {"hexahedron": hexes.cells, "pyramid": [apex]},
                           {"hexahedron": [1], "pyramid": [2]})
        self.assertEqual({kind: cells.shape for kind, cells in mesh.cells.items()},
                         {"hexahedron": (1, 8), "pyramid": (1, 5)})
        self.assertEqual(mesh.regions["pyramid"].tolist(), [2])
        self.assertAlmostEqual(mesh.volume, 1 + 1 / 3)

    def test_files_keep_the_bits(self) -> None:
        mesh = incise.Mesh.box([0.1, 0.3, 0.7], [2, 3, 1])
        with tempfile.TemporaryDirectory() as folder:
            for ending in (".vtu", ".vtk", ".msh", ".mesh", ".inp"):
                path = pathlib.Path(folder) / f"box{ending}"
                mesh.write(path)
                again = incise.read_mesh(path)
                np.testing.assert_array_equal(again.points, mesh.points)
                np.testing.assert_array_equal(again.cells, mesh.cells)
            with self.assertRaises(incise.InputError):
                mesh.write(pathlib.Path(folder) / "box.doc")

    def test_organ_is_read(self) -> None:
        liver = incise.read_mesh(support.SOURCES / "data" / "liver.vtu")
        self.assertEqual(liver.cells.shape[1], 4)
        self.assertGreater(liver.volume, 1e-4)


class Cuts(unittest.TestCase):
    def setUp(self) -> None:
        self.block = incise.Mesh.box([0.1, 0.1, 0.1], [3, 3, 3])

    def volumes(self, result: incise.CutResult) -> list[float]:
        return [round(piece["volume"], 9) for piece in result.report["pieces"]]

    def test_plane(self) -> None:
        result = incise.cut(self.block, planes=[([0.03, 0, 0], [1, 0, 0])])
        self.assertEqual(self.volumes(result), [0.0007, 0.0003])
        self.assertAlmostEqual(result.report["cut_area"], 0.01)
        self.assertLess(abs(result.report["volume_error"]), 1e-12)
        self.assertAlmostEqual(result.mesh.volume, 0.001)
        self.assertEqual(self.block.num_cells, 162)

    def test_surface_of_arrays_and_of_a_file(self) -> None:
        points = [[0.03, -1, -1], [0.03, 2, -1], [0.03, -1, 2]]
        result = incise.cut(self.block, surfaces=[(points, [[0, 1, 2]])])
        self.assertEqual(self.volumes(result), [0.0007, 0.0003])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "cut.off"
            path.write_text("OFF\n3 1 0\n" + "".join("{} {} {}\n".format(*p) for p in points)
                            + "3 0 1 2\n")
            again = incise.cut(self.block, surfaces=[path])
        self.assertEqual(self.volumes(again), self.volumes(result))

    def test_sweep_and_modes(self) -> None:
        edge = np.array([[0.05, -1, 0], [0.05, 1, 0]])
        sweep = np.stack([edge + [0, 0, 0.2], edge - [0, 0, 0.1]])
        result = incise.cut(self.block, sweeps=[sweep])
        self.assertEqual(len(result.report["pieces"]), 2)
        hexes = incise.Mesh.box([0.1, 0.1, 0.1], [4, 2, 2], "hex")
        result = incise.cut(hexes, sweeps=[sweep], mode="separate")
        self.assertEqual(len(result.report["pieces"]), 2)
        self.assertEqual(result.mesh.num_cells, 16)
        result = incise.cut(hexes, planes=[([0.04, 0, 0], [1, 0, 0])])
        self.assertEqual(len(result.report["pieces"]), 2)
        self.assertEqual(result.mesh.num_cells, 20)

    def test_removals(self) -> None:
        for tool in ({"remove_spheres": [([0, 0, 0], 0.05)]},
                     {"remove_boxes": [([0, 0, 0], [0.03, 0.1, 0.1])]},
                     {"remove_capsules": [([0, 0, 0], [0.1, 0, 0], 0.03)]}):
            result = incise.cut(self.block, **tool)
            self.assertGreater(result.report["elements_removed"], 0)
            self.assertAlmostEqual(result.mesh.volume + result.report["volume_removed"], 0.001)

    def test_tool_that_misses_warns(self) -> None:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            incise.cut(self.block, planes=[([5, 0, 0], [1, 0, 0])])
        self.assertIn("cuts nothing", str(caught[0].message))

    def test_wrong_tools_are_refused(self) -> None:
        for tool in ({"planes": [([0, 0, 0], [0, 0, 0])]}, {"planes": [[0, 0, 0]]},
                     {"planes": [([0, 0, 0], [float("nan"), 0, 0])]},
                     {"surfaces": [([[0, 0, 0]], [[0, 0, 1]])]}, {"surfaces": ["none.stl"]},
                     {"sweeps": [[[0, 0, 0]]]}, {"remove_spheres": [([0, 0, 0], -1)]},
                     {"remove_boxes": [([1, 1, 1], [0, 0, 0])]}, {"mode": "cut"},
                     {"planes": [([0.03, 0, 0], [1, 0, 0])], "snap": 0.7}):
            with self.assertRaises(incise.InputError, msg=str(tool)):
                incise.cut(self.block, **tool)

    def test_a_cut_mesh_makes_a_world(self) -> None:
        result = incise.cut(self.block, planes=[([0.03, 0, 0], [1, 0, 0])])
        body = incise.World(mesh=result.mesh, materials=[support.MATERIAL])
        body.step()
        self.assertEqual(body.ledger()["components"], 2)

    def test_cut_hexahedra_go_through_files(self) -> None:
        bricks = incise.Mesh.box([1, 1, 1], [2, 2, 2], "hex")
        first, second = ([0.4, 0, 0], [1, 0, 0.1]), ([0, 0.4, 0], [0.2, 1, 0])
        once = incise.cut(bricks, planes=[first]).mesh
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "cut.vtu"
            once.write(path)
            read = incise.read_mesh(path)
        faces = read.cells["polyhedron"]
        np.testing.assert_array_equal(faces, once.cells["polyhedron"])
        num_polyhedra, at = 0, 0
        while at < len(faces):
            num_polyhedra += 1
            num_faces, at = faces[at], at + 1
            for _ in range(num_faces):
                self.assertTrue((faces[at + 1:at + 1 + faces[at]] < read.num_points).all())
                at += 1 + faces[at]
        self.assertEqual(at, len(faces))
        self.assertEqual(num_polyhedra, len(read.regions["polyhedron"]))
        self.assertAlmostEqual(read.volume, 1.0)
        self.assertAlmostEqual(read.surface_area, once.surface_area)
        again = incise.cut(read, planes=[second]).mesh
        at_once = incise.cut(bricks, planes=[first, second]).mesh
        np.testing.assert_array_equal(again.points, at_once.points)
        np.testing.assert_array_equal(again.cells["polyhedron"], at_once.cells["polyhedron"])
        body = incise.World(mesh=read, materials=[support.MATERIAL])
        body.step()
        self.assertEqual(body.ledger()["components"], 2)


if __name__ == "__main__":
    unittest.main()
