"""Train a small policy to cut along a line, by the cross-entropy method, in numpy alone.

    python train_cut.py                      # a minute; draws train_cut.png with matplotlib
    python train_cut.py --generations 4      # a shorter one
    python train_cut.py --processes 4        # episodes in processes of their own; the same figures

The method keeps a normal distribution of the parameters of the policy. In each generation it draws
a population from it, runs each of them in the environment, and fits the distribution to the best.

The block has coarser elements than by default, which halves the time: two layers of 5 mm, of which
the blade is to cut the upper one.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
import argparse
import math
import multiprocessing
from typing import Any, Callable, Iterable, Optional

import numpy as np
import numpy.typing as npt

import incise.envs

Floats = npt.NDArray[np.float64]
Progress = Callable[[str], None]

NUM_ACTIONS, NUM_FEATURES = 3, 4
NUM_PARAMETERS = NUM_ACTIONS * NUM_FEATURES


def act(parameters: Floats, observation: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Return the action of the policy, shape (3,): linear in four features, within -1 and 1.

    The features are the error of the depth, the angles to two points of the line, and 1.
    """
    depth = float(observation[3])
    near = math.atan2(observation[15], observation[14])
    far = math.atan2(observation[19], observation[18])
    seen = np.array([3.0 * (depth - 1.0), 3.0 * near, 3.0 * far, 1.0])
    return np.tanh(parameters.reshape(NUM_ACTIONS, NUM_FEATURES) @ seen).astype(np.float32)


class Episodes:
    """Runs episodes in an environment that it makes once in each process."""

    env: Optional[incise.envs.PathIncisionEnv] = None

    def __call__(self, task: tuple[Floats, list[int]]) -> tuple[float, float]:
        """Return mean return and share of successes of parameters over the seeds of a task."""
        parameters, seeds = task
        if Episodes.env is None:
            Episodes.env = incise.envs.PathIncisionEnv(cells=(10, 1, 2), depth=0.005,
                                                       max_episode_steps=150)
        env, returns, successes = Episodes.env, [], []
        for seed in seeds:
            observation, info = env.reset(seed=seed)
            total, is_over = 0.0, False
            while not is_over:
                observation, reward, terminated, truncated, info = env.step(
                    act(parameters, observation))
                total += reward
                is_over = terminated or truncated
            returns.append(total)
            successes.append(info["success"])
        return float(np.mean(returns)), float(np.mean(successes))


def train(generations: int = 20, population: int = 30, num_best: int = 6, num_episodes: int = 2,
          seed: int = 0, processes: int = 1, report: Progress = print) -> dict[str, Any]:
    """Train and return mean, spread (P,), and the history, shape (generations, 4).

    Columns of the history: generation, mean return of the population, mean return of the best, and
    return of the mean parameters on seeds that are not trained on.
    """
    random = np.random.default_rng(seed)
    mean, spread = np.zeros(NUM_PARAMETERS), np.ones(NUM_PARAMETERS)
    run = Episodes()
    test_seeds = list(range(10**6, 10**6 + 5))
    history = []
    pool = multiprocessing.get_context("spawn").Pool(processes) if processes > 1 else None

    def run_all(tasks: Iterable[tuple[Floats, list[int]]]) -> list[tuple[float, float]]:
        return pool.map(run, tasks) if pool else [run(task) for task in tasks]

    try:
        report("generation  population     best  test return  test success")
        for generation in range(generations):
            # All of a generation cut along the same lines, so that they can be compared.
            seeds = [1000 * generation + i for i in range(num_episodes)]
            tried = mean + spread * random.normal(size=(population, NUM_PARAMETERS))
            returns = np.array([r for r, _ in run_all((p, seeds) for p in tried)])
            best = tried[np.argsort(-returns, kind="stable")[:num_best]]
            mean = best.mean(axis=0)
            # A floor that falls keeps the search from ending early.
            spread = best.std(axis=0) + 0.3 * max(0.0, 1.0 - generation / 12.0)
            [(test_return, success)] = run_all([(mean, test_seeds)])
            top = float(np.sort(returns)[-num_best:].mean())
            history.append((generation, float(returns.mean()), top, test_return))
            report(f"{generation:10d} {returns.mean():11.2f} {top:8.2f} {test_return:12.2f} "
                   f"{success:13.0%}")
    finally:
        if pool:
            pool.terminate()
    return {"mean": mean, "spread": spread, "history": np.array(history)}


def draw(history: Floats, path: str) -> None:
    """Write the learning curve as a picture."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
    for column, label in ((1, "population"), (2, "best fifth"), (3, "mean policy, other lines")):
        axes.plot(history[:, 0], history[:, column], label=label)
    axes.set(xlabel="generation", ylabel="mean return")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=100)


def main() -> None:
    """Train as the command line says."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--generations", type=int, default=20)
    parser.add_argument("--population", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--picture", default="train_cut.png")
    arguments = parser.parse_args()
    result = train(arguments.generations, arguments.population, seed=arguments.seed,
                   processes=arguments.processes)
    try:
        draw(result["history"], arguments.picture)
    except ImportError:
        print("no matplotlib, so no picture of the learning curve")


if __name__ == "__main__":
    main()
