"""Environments for robot learning: cutting soft tissue, with Gymnasium's interface.

>>> import incise.envs
>>> env = incise.envs.PathIncisionEnv()
>>> observation, info = env.reset(seed=1)
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

They need numpy only. Where gymnasium is installed, they are environments of gymnasium, and
importing this module registers them for gymnasium.make(): Incise/Dissection-v0,
Incise/PathIncision-v0 and Incise/WedgeResection-v0. docs/robot-learning.md of the sources is the
guide.
"""
# SPDX-License-Identifier: LGPL-3.0-or-later
from .check import check_env
from .dissection import DissectionEnv
from .gym import HAS_GYMNASIUM, Box, Dict, Discrete, Env, ResetNeeded, Space, register
from .path_incision import PathIncisionEnv
from .wedge_resection import WedgeResectionEnv

IDS = {
    "Incise/Dissection-v0": "incise.envs:DissectionEnv",
    "Incise/PathIncision-v0": "incise.envs:PathIncisionEnv",
    "Incise/WedgeResection-v0": "incise.envs:WedgeResectionEnv",
}
register(IDS)

__all__ = ["Box", "Dict", "Discrete", "DissectionEnv", "Env", "HAS_GYMNASIUM", "IDS",
           "PathIncisionEnv", "ResetNeeded", "Space", "WedgeResectionEnv", "check_env"]
