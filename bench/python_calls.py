#!/usr/bin/env python3
"""Measures what a call through the module of Python costs.

    PYTHONPATH=build/release/python bench/python_calls.py build/release/tests/python/python_reference

The argument is the program that makes the same steps in C++.
SPDX-License-Identifier: LGPL-3.0-or-later
"""

import subprocess
import sys
import time
import timeit

import incise
from incise import envs


def small_world(cells: list[int]) -> incise.World:
    return incise.World(mesh={"box": {"size": [1, 1, 1], "cells": cells}},
                        materials=[{"density": 1000, "law": "stable-neo-hookean",
                                    "lame_lambda": 1e5, "lame_mu": 3e4}])


def step_of_the_smallest_world(reference: str) -> None:
    body = small_world([1, 1, 1])
    # The least of several rounds of each, one after the other: other programs run too.
    through_python, without = 1.0, 1.0
    for _ in range(3):
        output = subprocess.run([reference, "time"], check=True, capture_output=True, text=True)
        without = min(without, float(output.stdout))
        through_python = min(through_python, *timeit.repeat(body.step, number=20000, repeat=5))
    print(f"a step of 6 elements: {1e6 * without:.2f} us in C++, "
          f"{1e6 * through_python / 20000:.2f} us through Python")


def many_steps_at_once() -> None:
    body = small_world([4, 4, 3])
    dt = 0.8 * body.stable_step
    one_by_one = min(timeit.repeat(lambda: body.step(dt), number=2000, repeat=3)) / 2000
    at_once = min(timeit.repeat(lambda: body.step(dt, n=2000), number=1, repeat=3)) / 2000
    print(f"{body.num_cells} elements: {1e6 * one_by_one:.1f} us a step one by one, "
          f"{1e6 * at_once:.1f} us at once")


def state_and_arrays() -> None:
    body = small_world([4, 4, 3])
    state = body.save()
    save = min(timeit.repeat(body.save, number=10, repeat=5)) / 10
    restore = min(timeit.repeat(lambda: body.restore(state), number=10, repeat=5)) / 10
    copy = min(timeit.repeat(lambda: body.positions, number=1000, repeat=5)) / 1000
    print(f"{body.num_cells} elements: save {1e3 * save:.2f} ms, restore {1e3 * restore:.2f} ms, "
          f"{len(state)} bytes, positions {1e6 * copy:.2f} us")


def environments() -> None:
    for kind in (envs.DissectionEnv, envs.PathIncisionEnv, envs.WedgeResectionEnv):
        env = kind()
        env.reset(seed=1)
        env.action_space.seed(1)
        actions = [env.action_space.sample() for _ in range(2000)]
        least = float("inf")
        for _ in range(3):
            begin = time.process_time()
            for action in actions:
                *_, terminated, truncated, _ = env.step(action)
                if terminated or truncated:
                    env.reset()
            least = min(least, time.process_time() - begin)
        pictures = [min(timeit.repeat(lambda: env.picture(shape), number=5, repeat=5)) / 5
                    for shape in ((96, 96), (400, 600))]
        print(f"{kind.__name__}, {env.world.num_cells} elements: {len(actions) / least:.0f} random "
              f"steps a second of one core, pictures of 96 x 96 {1e3 * pictures[0]:.1f} ms, of "
              f"400 x 600 {1e3 * pictures[1]:.1f} ms")


if __name__ == "__main__":
    step_of_the_smallest_world(sys.argv[1])
    many_steps_at_once()
    state_and_arrays()
    environments()
