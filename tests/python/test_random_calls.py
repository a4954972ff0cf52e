"""Calls in random order with random arguments raise exceptions, and never crash."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import subprocess
import sys
import tempfile
import unittest

NUM_CALLS = 10000

SCRIPT = r"""
import faulthandler, gc, inspect, os, random, resource, signal, sys, warnings
faulthandler.enable()
resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30))
warnings.simplefilter("ignore")
import numpy as np
import incise, support

seed, num_calls = int(sys.argv[1]), int(sys.argv[2])
source = random.Random(seed)
folder = sys.argv[3]
os.chdir(folder)
JAWS = {"kind": "grasper", "shape": {"sphere": {"radius": 0.015}}}
PROBE = {"kind": "probe", "shape": {"capsule": {"from": [0, 0, 0], "to": [0, 0, 0.02],
                                                "radius": 0.004}}}
BURR = {"kind": "carver", "shape": {"sphere": {"radius": 0.012}}}
THREAD = {"kind": "suture", "stiffness": 50.0, "points": [[0.06, 0.02, 0.04], [0.1, 0.02, 0.04]]}
PLANE = {"kind": "cut", "plane": {"point": [0.05, 0, 0], "normal": [1, 0, 0.2]}}

class Own:
    def __getattr__(self, name): raise RuntimeError(name)
    def __len__(self): return 3
    def __getitem__(self, i):
        if i > 2: raise IndexError(i)
        return i
class Evil(incise.World):
    def __init__(self): pass

def number():
    return source.choice([0, 1, -1, 2, 1e-5, 1e-4, 1e-3, 0.01, 0.05, float("nan"), float("inf"),
                          -0.0, 1e300, 2**63, -2**70, np.float32(0.01), np.int64(3), True])
def vector():
    kind = source.randrange(8)
    if kind == 0: return [number() for _ in range(source.randrange(5))]
    if kind == 1: return np.array(source.choice([[], [[0, 0, 0]], [1j, 2, 3], ["a", "b", "c"]]))
    return [source.uniform(-0.02, 0.14) for _ in range(3)]
def pose():
    if source.random() < 0.1: return source.choice([None, 3, vector(), Own()])
    quaternion = [source.uniform(-1, 1) for _ in range(4)] if source.random() < 0.5 else None
    try: return incise.Pose(vector(), quaternion)
    except (ValueError, TypeError, OverflowError, incise.Error): return incise.Pose([0.06, 0, 0.05])
def small_time(): return source.choice([1e-5, 1e-4, 3e-4])
def thing():
    return source.choice([None, 3, "x", b"bytes", [], {}, (), object(), Own(), np.zeros(3), vector(),
                          number(), incise, incise.Pose(), [1, [2, [3]]], {"a": {1}},
                          {"kind": "blade"}, support.BLADE, JAWS, lambda: 1, "\ud800", "a\0b"])
def definition():
    base = dict(source.choice([support.BLADE, JAWS, PROBE, BURR, THREAD, PLANE]))
    if source.random() < 0.3: base[source.choice(["kind", "edge", "shape", "snap", "mode", "x"])] = thing()
    return base
def make():
    if source.random() < 0.2:
        return incise.World("beam.toml") if source.random() < 0.5 else incise.World(
            support.SCENARIOS / "beam.toml")
    sections = {}
    if source.random() < 0.3:
        sections[source.choice(["mesh", "materials", "constraints", "loads", "tools", "dynamics",
                                "contact", "gravity", "damping", "num_threads", "overrides",
                                "folder"])] = thing()
    if source.random() < 0.3: sections["mesh"] = support.box((3, 2, 2), "hex")
    return support.world(**{"mesh": support.box((4, 2, 2)), **sections})

def stop(number, frame): raise TimeoutError()
signal.signal(signal.SIGALRM, stop)
worlds = [support.world(mesh=support.box((4, 2, 2))) for _ in range(2)]
others, states, kept = [], [], []
def world(): return source.choice(worlds)
def steps(n):
    body = world()
    if body.time > 1.0: return  # what was crushed has tiny steps: few of them
    return source.choice([lambda: body.step(n=n), lambda: body.run_until(
                              body.time + min(small_time(), 30 * body.stable_step)),
                          lambda: body.step(number(), n), lambda: body.step(small_time())])()
def enter_view():
    body = world()
    with body.view() as view:
        array = view.positions if source.random() < 0.5 else view.velocities
        if source.random() < 0.05: kept.append(array)
        if source.random() < 0.1: steps(1)
        return array.sum()
def tool_call():
    tools = list(world().tools.values())
    if not tools: return
    tool = source.choice(tools)
    name = source.choice([n for n in dir(tool) if not n.startswith("__")])
    member = getattr(tool, name)
    if name in ("pose",): tool.pose = pose()
    elif callable(member):
        return member(*[source.choice([pose, number, thing])()
                        for _ in range(source.choice([0, 0, 1, 1, 2]))])
def anything():
    target = source.choice([world(), incise.World, incise, incise.Mesh, *others[-5:]])
    name = source.choice([n for n in dir(target) if not n.startswith("_")])
    member = getattr(target, name)
    if callable(member):
        arguments = [thing() for _ in range(source.randrange(4))]
        if name in ("run_until", "step"):  # may be asked for years
            signal.setitimer(signal.ITIMER_REAL, 0.2)
        try: others.append(member(*arguments))
        finally: signal.setitimer(signal.ITIMER_REAL, 0)
    elif source.random() < 0.3:
        setattr(target if target is not incise and not inspect.isclass(target) else Own(), name,
                thing())
def save():
    if source.random() < 0.5 or not states: states.append(world().save())
    elif source.random() < 0.7: world().restore(source.choice(states))
    else:
        damaged = bytearray(source.choice(states))
        damaged[source.randrange(len(damaged))] ^= 1 << source.randrange(8)
        world().restore(bytes(damaged))
def replace():
    worlds[source.randrange(len(worlds))] = make()
def grasp():
    body = world()
    if source.random() < 0.7:
        nodes = [source.randrange(-1, body.num_nodes + 1) for _ in range(source.randrange(4))]
        body.grasp(f"g{source.randrange(50)}", source.choice([nodes, nodes, thing()]), pose())
    for constraint in body.constraints.values():
        if constraint.is_grasp:
            source.choice([lambda: setattr(constraint, "pose", pose()), constraint.release,
                           lambda: constraint.force])()
def change():
    body = world()
    where = {"box": {"min": [-1, -1, source.choice([-1, 0.039])], "max": [1, 1, 1]}}
    part = dict(source.choice([
        {"where": where, "fix": source.choice(["x", "xyz", "q"])}, {"where": where, "pressure": number()},
        {"where": where, "nodal_force": vector()}, {"where": where, "fix": "z", "move": [
            {"time": number(), "by": vector()}]}]))
    if source.random() < 0.3: part[source.choice(["where", "fix", "factor", "name", "x"])] = thing()
    material = {**support.MATERIAL, "young": source.choice([1e3, 3e4, number()])}
    if source.random() < 0.3: material[source.choice(["density", "law", "prony", "regions"])] = thing()
    source.choice([
        lambda: body.add_constraint(f"c{source.randrange(9)}", part),
        lambda: body.add_load(f"l{source.randrange(9)}", part),
        lambda: [source.choice([lambda: c.change(part), c.release])()
                 for c in body.constraints.values() if c.name != "clamp"],
        lambda: [source.choice([lambda: load.change(part), load.remove])()
                 for load in body.loads.values()],
        lambda: body.set_material(material), lambda: body.set_gravity(vector()),
        lambda: body.set_damping(number()), lambda: body.undo_point(), lambda: body.undo()])()
def picture():
    world().render(source.choice([8, 8, number()]), 6, source.choice([vector(), thing(), {
        "position": vector(), source.choice(["target", "field_of_view", "x"]): vector()}]),
        source.choice(["rgb", "depth", ("rgb", "segmentation"), thing()]))
def arrays():
    body = world()
    for name in ("positions", "velocities", "masses", "cells", "regions", "elements", "components",
                 "surface", "node_ids", "contact_forces", "rest_positions"):
        kept.append(getattr(body, name))
def meshes():
    block = incise.Mesh.box([0.1, 0.1, 0.1], [2, 2, source.randrange(3)])
    incise.cut(block, **{source.choice(["planes", "surfaces", "sweeps", "remove_spheres",
                                        "remove_boxes", "remove_capsules", "snap", "mode"]):
                         source.choice([[thing()], thing(), [(vector(), vector())],
                                        [(vector(), number())], [(vector(), vector(), number())]])})
def points_and_cells():
    points = np.array([[source.uniform(0, 1) for _ in range(3)] for _ in range(5)])
    cells = [[source.randrange(-1, 6) for _ in range(source.choice([4, 4, 4, 5, 8]))]
             for _ in range(source.randrange(3))]
    mesh = incise.Mesh(points, source.choice([cells, cells, thing()]),
                       source.choice([None, [1], thing()]))
    worlds[0] = incise.World(mesh=mesh, materials=[support.MATERIAL])
def unmade():
    source.choice([lambda: incise.World.__new__(incise.World).time, lambda: Evil().step(),
                   lambda: incise.Tool().name, lambda: incise.Surface().triangles,
                   lambda: incise.World.__new__(incise.World).view(),
                   lambda: incise.Mesh.__new__(incise.Mesh).points,
                   lambda: incise.World(mesh=incise.Mesh.__new__(incise.Mesh))])()
def add():
    if len(world().tools) < 12:
        others.append(world().add_tool(source.choice([f"t{source.randrange(40)}", "", "a b"]),
                                       definition(), source.choice([None, pose()])))

calls = ([lambda: steps(source.choice([1, 2, 5]))] * 8 + [tool_call] * 8 + [enter_view] * 3 +
         [anything] * 6 + [save] * 2 + [grasp] * 2 + [arrays] * 2 + [change] * 4 + [picture] * 2 +
         [add] * 3 + [meshes, points_and_cells, unmade, replace, lambda: world().ledger(),
                      lambda: world().edits(), lambda: world().write_vtu("x.vtu")])
raised, done = {}, 0
for i in range(num_calls):
    call = source.choice(calls)
    try:
        call()
        done += 1
    except Exception as error:
        kind = type(error).__name__
        raised[kind] = raised.get(kind, 0) + 1
        assert kind != "SystemError", error
        if kind == "RuntimeError":
            # Own's: the name of a member. Others: what pybind11 says of objects without a value.
            assert str(error).isidentifier() or "__init__" in str(error) or \
                "Unable to cast" in str(error), error
    if len(kept) > 60: del kept[:50]
    others[:] = [o for o in others if type(o).__module__ == "incise"][-20:]
    if len(states) > 6: del states[0]
    if i % 500 == 0: gc.collect()
print(done, raised)
"""


class RandomCalls(unittest.TestCase):
    def run_script(self, seed: int, num_calls: int) -> None:
        with tempfile.TemporaryDirectory() as folder:
            paths = os.pathsep.join([os.getcwd(), os.environ.get("PYTHONPATH", "")])
            done = subprocess.run(
                [sys.executable, "-c", SCRIPT, str(seed), str(num_calls), folder], text=True,
                capture_output=True, env={**os.environ, "PYTHONPATH": paths}, timeout=300)
        print(f"\nseed {seed}: {done.stdout.strip()}")
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])

    def test_nothing_crashes(self) -> None:
        seed = int(os.environ.get("INCISE_SEED", "1"))
        for part in range(5):
            self.run_script(seed + part, NUM_CALLS // 5)


if __name__ == "__main__":
    unittest.main()
