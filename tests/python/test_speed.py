"""What a call through Python costs."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import os
import subprocess
import timeit
import unittest

import incise


class Speed(unittest.TestCase):
    def test_a_step_costs_at_most_three_microseconds_more(self) -> None:
        body = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
                            materials=[{"density": 1000, "law": "stable-neo-hookean",
                                        "lame_lambda": 1e5, "lame_mu": 3e4}])
        # The least of several rounds of each, one after the other: other programs run too.
        through_python, without = 1.0, 1.0
        for _ in range(3):
            without = min(without, float(subprocess.run(
                [os.environ["INCISE_REFERENCE"], "time"], check=True, capture_output=True,
                text=True).stdout))
            through_python = min(through_python,
                                 *timeit.repeat(body.step, number=20000, repeat=5))
        through_python /= 20000
        print(f"\na step: {1e6 * without:.2f} us in C++, {1e6 * through_python:.2f} us in Python")
        self.assertLess(through_python - without, 3e-6)

    def test_a_call_of_many_steps_costs_little(self) -> None:
        body = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [4, 4, 3]}},
                            materials=[{"density": 1000, "law": "stable-neo-hookean",
                                        "young": 1e4, "poisson": 0.4}])
        dt = 0.8 * body.stable_step
        one_by_one = min(timeit.repeat(lambda: body.step(dt), number=2000, repeat=3)) / 2000
        at_once = min(timeit.repeat(lambda: body.step(dt, n=2000), number=1, repeat=3)) / 2000
        print(f"\n{body.num_cells} elements: {1e6 * one_by_one:.1f} us a step one by one, "
              f"{1e6 * at_once:.1f} us at once")
        self.assertLess(at_once, 1.2 * one_by_one)

    def test_state_is_quick(self) -> None:
        body = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [4, 4, 3]}},
                            materials=[{"density": 1000, "young": 1e4, "poisson": 0.4}])
        state = body.save()
        save = min(timeit.repeat(body.save, number=10, repeat=5)) / 10
        restore = min(timeit.repeat(lambda: body.restore(state), number=10, repeat=5)) / 10
        copy = min(timeit.repeat(lambda: body.positions, number=1000, repeat=5)) / 1000
        print(f"\n{body.num_cells} elements: save {1e3 * save:.2f} ms, restore "
              f"{1e3 * restore:.2f} ms, {len(state)} bytes, positions {1e6 * copy:.2f} us")
        self.assertLess(restore, 0.1)


if __name__ == "__main__":
    unittest.main()
