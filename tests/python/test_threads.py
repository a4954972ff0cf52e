"""Worlds and threads."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import incise
import support


class Threads(unittest.TestCase):
    def test_several_worlds_step_at_the_same_time(self) -> None:
        def run(x: float) -> np.ndarray:
            body = support.world(gravity=[0, 0, -9.81])
            support.cut_through(body, x)
            return body.positions

        places = [0.03, 0.05, 0.07, 0.09] * 2
        alone = [run(x) for x in places]
        with ThreadPoolExecutor(4) as pool:
            together = list(pool.map(run, places))
        for a, b in zip(alone, together):
            np.testing.assert_array_equal(a, b)

    def test_a_step_lets_other_threads_run(self) -> None:
        body = support.world()
        num_awake, done = 0, threading.Event()

        def step() -> None:
            body.run_until(100.0)
            done.set()

        thread = threading.Thread(target=step)
        thread.start()
        while not done.is_set():
            time.sleep(1e-3)
            num_awake += 1
        thread.join()
        self.assertGreater(num_awake, 10)  # a call that held the lock would leave one or two

    def test_one_world_in_two_threads_raises(self) -> None:
        body = support.world()
        began = threading.Event()

        def step() -> None:
            began.set()
            body.run_until(100.0)

        thread = threading.Thread(target=step)
        thread.start()
        began.wait()
        refused = 0
        while thread.is_alive():
            for use in (lambda: body.time, lambda: body.positions, lambda: body.step(),
                        lambda: body.add_tool("x", {}), lambda: body.view().__enter__(),
                        lambda: body.surface, lambda: body.save(), lambda: body.edits()):
                try:
                    use()
                except incise.Error as error:
                    refused += "another thread uses this world" in str(error)
                    break
        thread.join()
        self.assertGreater(refused, 0)
        self.assertGreaterEqual(body.time, 100.0)

    def test_many_threads_hammer_one_world(self) -> None:
        body = support.world()
        state = body.save()
        kinds: set[str] = set()

        def hammer(i: int) -> None:
            for k in range(150):
                try:
                    if (i + k) % 5 == 0:
                        body.restore(state)
                    elif (i + k) % 5 == 1:
                        with body.view() as view:
                            view.positions.sum()
                    elif (i + k) % 5 == 2:
                        body.surface.triangles.sum()
                    else:
                        body.step(n=20)
                except (incise.Error, BufferError) as error:
                    kinds.add(type(error).__name__)

        threads = [threading.Thread(target=hammer, args=(i,)) for i in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertLessEqual(kinds, {"Error", "BufferError"})
        body.step()

    def interrupted(self, script: str) -> str:
        """Run a script, and interrupt it after it has printed 'begun'. Return what follows."""
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE,
                                   text=True)
        assert process.stdout is not None
        self.assertEqual(process.stdout.readline(), "begun\n")
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        return out

    def test_an_interrupt_ends_a_long_call_between_steps(self) -> None:
        script = textwrap.dedent("""
            import support
            body = support.world()
            print("begun", flush=True)
            try:
                body.run_until(1e4)
            except KeyboardInterrupt:
                body.step()
                print("stopped", body.has_failed)
        """)
        self.assertEqual(self.interrupted(script), "stopped False\n")

    def test_after_an_interrupt_a_grasp_goes_on_from_where_it_is(self) -> None:
        script = textwrap.dedent("""
            import incise, support
            body = support.world()
            held = (body.positions[:, 0] > 0.119).nonzero()[0]
            rest = body.positions[held[0], 2]
            grasp = body.grasp("hand", held)
            begin = grasp.pose.position
            grasp.pose = incise.Pose(begin + [0, 0, 1e3])  # far away, and slowly
            print("begun", flush=True)
            try:
                body.run_until(1e7)
            except KeyboardInterrupt:
                z = float(body.positions[held[0], 2] - rest)
                grasp.pose = incise.Pose(begin + [0, 0, z])  # where it is: so it stays there
                body.step(n=2)
                print(0 < z < 1e3, bool(abs(body.velocities[held]).max() < 1e-3), body.has_failed)
        """)
        self.assertEqual(self.interrupted(script), "True True False\n")

    def test_python_ends_while_a_daemon_steps_a_world(self) -> None:
        for work in ("body.step(n=10**9)", "[body.step(n=3) for _ in iter(int, 1)]",
                     "[incise.Mesh.box([1, 1, 1], [9, 9, 9]) for _ in iter(int, 1)]"):
            script = textwrap.dedent(f"""
                import threading, time
                import incise, support
                body = support.world()
                threading.Thread(target=lambda: {work}, daemon=True).start()
                time.sleep(0.2)
            """)
            for _ in range(3):
                process = subprocess.run([sys.executable, "-c", script], capture_output=True,
                                         text=True, timeout=60)
                self.assertEqual((process.returncode, process.stderr), (0, ""), work)

    def test_worlds_work_while_python_ends(self) -> None:
        script = textwrap.dedent("""
            import atexit
            def late():  # runs after what incise does at the end
                body.step()
                body.write_vtu("late.vtu")
            atexit.register(late)
            import incise, support
            def early():
                body.step()
                body.write_vtu("early.vtu")
            atexit.register(early)
            class Holder:
                def __del__(self):
                    self.body.step()
                    self.body.write_vtu("last.vtu")
            body = support.world()
            holder = Holder()
            holder.body = body
        """)
        with tempfile.TemporaryDirectory() as folder:
            paths = os.pathsep.join([os.getcwd(), os.environ.get("PYTHONPATH", "")])
            done = subprocess.run([sys.executable, "-c", script], cwd=folder, text=True,
                                  capture_output=True, timeout=60,
                                  env={**os.environ, "PYTHONPATH": paths})
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(sorted(os.listdir(folder)), ["early.vtu", "last.vtu", "late.vtu"])

    def test_a_child_ends_though_a_thread_of_its_parent_steps(self) -> None:
        script = textwrap.dedent("""
            import os, threading, time
            import incise, support
            body = support.world()
            threading.Thread(target=lambda: body.step(n=10**9), daemon=True).start()
            time.sleep(0.2)
            child = os.fork()
            if child == 0:
                raise SystemExit(7)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
        """)
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True,
                              timeout=60)
        self.assertEqual((done.returncode, done.stdout), (0, "7\n"), done.stderr)


if __name__ == "__main__":
    unittest.main()
