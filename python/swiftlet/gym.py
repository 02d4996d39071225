"""Environments of reinforcement learning with the interface of Gymnasium 1: a vehicle hovers at a target.

>>> from swiftlet.gym import HoverEnv, HoverVectorEnv
>>> env = HoverVectorEnv(64, level="rates")
>>> observations, infos = env.reset(seed=1)
>>> observations, rewards, terminated, truncated, infos = env.step(actions)

HoverEnv has one vehicle, HoverVectorEnv many, which one call steps on several threads. If the package `gymnasium` is installed,
they are subclasses of gymnasium.Env and gymnasium.vector.VectorEnv with its spaces; else they have the same methods and members
without it (USES_GYMNASIUM says which).

The vehicle starts in the air near the target with random position, velocity, attitude and body rates. Simulated are the vehicle
with rotors and battery, its firmware, its sensors, wind, ground and links, as the simulation file has them. With a dispersion,
each episode has a vehicle and a simulation of its own.

Action, by `level`, float64; a component beyond its bound is clipped:

- "actuators": (rotors,), throttle of each rotor, 0 .. 1
- "rates": (4,), body rates p, q, r (rad/s, FRD) and thrust over mass (m/s^2, along -z of FRD)
- "attitude": (4,), roll, pitch, yaw (rad; yaw from north towards east) and thrust over mass (m/s^2)
- "trajectory": (4,), velocity north, east, down (m/s) and yaw rate (rad/s)

Observation, (18 + rotors,), float64, of the ground truth:

- [0:3] target minus position, m, NED
- [3:6] velocity, m/s, NED
- [6:15] rotation matrix from FRD to NED, row by row
- [15:18] body rates, rad/s, FRD
- [18:] speed of each rotor over that of hover

The reward of a step is action_period_s * (1 - distance / radius_m - 0.02 * |body rates| / (rad/s)), so that an episode gives at
most episode_s; it is 0 for a step that terminates. An episode is terminated when the vehicle is further than radius_m from the
target, tips over (tilt above 90 degrees) or touches the ground, and truncated after episode_s.

The same seed and actions give bit-identical results, for any number of threads.
"""
import os
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

if TYPE_CHECKING:  # the members that are there with Gymnasium and without

    class _Env:
        def reset(self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None) -> Any:
            ...

    _VectorEnv = _Env
    from .spaces import Box

    USES_GYMNASIUM: bool
    _SAME_STEP: Any
else:
    try:
        from gymnasium import Env as _Env
        from gymnasium.spaces import Box as _GymnasiumBox
        from gymnasium.vector import AutoresetMode
        from gymnasium.vector import VectorEnv as _VectorEnv

        USES_GYMNASIUM = True
        _SAME_STEP = AutoresetMode.SAME_STEP

        def Box(low, high):
            return _GymnasiumBox(low, high, dtype=np.float64)

    except ImportError:
        from .spaces import Box

        USES_GYMNASIUM = False
        _SAME_STEP = "SameStep"

        class _Env:
            pass

        class _VectorEnv:
            pass


Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]


def _random_seed() -> int:
    return int.from_bytes(os.urandom(8), "little") >> 1


class HoverVectorEnv(_VectorEnv):
    """Many vehicles that hover, each by itself. Shapes have the number of environments in front."""

    metadata: Dict[str, Any] = {"render_modes": [], "autoreset_mode": _SAME_STEP}
    render_mode = None
    spec = None

    def __init__(
        self,
        num_envs: int = 1,
        *,
        level: str = "actuators",
        threads: int = 0,
        vehicle: Union[str, _core.VehicleModel] = "kaylion",
        simulation: Union[str, _core.SimulationSettings] = "default",
        dispersion: str = "",
        **task: Any,
    ) -> None:
        """threads: 0: one for each core. vehicle, simulation: names of files, their paths, or objects. dispersion: a file, or
        "uncertainty" of the vehicle file. task: action_period_s, episode_s, target_ned, radius_m, start_distance_m,
        start_speed_m_s, start_tilt_rad, start_rate_rad_s, and the bounds max_rate_rad_s, max_tilt_rad, max_speed_m_s and
        max_yaw_rate_rad_s; docs/python.md has their defaults. Throws swiftlet.InputError."""
        self._core = _core.HoverEnvironments(
            num_envs, level=level, threads=threads, vehicle=vehicle, simulation=simulation, dispersion=dispersion, **task
        )
        self.num_envs = num_envs
        size = self._core.observation_size
        low, high = self._core.action_low, self._core.action_high
        unbounded = np.full(size, np.inf)
        self.single_action_space = Box(low, high)
        self.single_observation_space = Box(-unbounded, unbounded)
        self.action_space = Box(np.tile(low, (num_envs, 1)), np.tile(high, (num_envs, 1)))
        self.observation_space = Box(np.tile(-unbounded, (num_envs, 1)), np.tile(unbounded, (num_envs, 1)))
        self._seeded = False

    def reset(
        self,
        *,
        seed: Union[int, Sequence[Optional[int]], None] = None,
        options: Optional[Dict[str, Any]] = None,
    ) -> Tuple[Floats, Dict[str, Any]]:
        """Begins an episode in all environments. seed: environment i has seed + i, or its own of a sequence; without a seed
        they go on with the next episode of theirs, and before the first one have seeds of the operating system."""
        seeds: Optional[List[int]] = None
        if isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + i for i in range(self.num_envs)]
        elif seed is not None:
            seeds = [_random_seed() if one is None else int(one) for one in seed]
        elif not self._seeded:
            seeds = [_random_seed() for _ in range(self.num_envs)]
        if seeds is not None and min(seeds) < 0:
            raise _core.InputError(f"seed is {min(seeds)}, must be at least 0")
        observations = self._core.reset(None if seeds is None else np.array(seeds, dtype=np.uint64))
        self._seeded = True
        return observations, {}

    def step(self, actions: ArrayLike) -> Tuple[Floats, Floats, Flags, Flags, Dict[str, Any]]:
        """Returns observations, rewards, terminated, truncated, infos. Where an episode ends, the next one begins in the same
        step: its row of the observations is the first of that, and infos["final_obs"] has the last one, with
        infos["_final_obs"] true there (autoreset mode SAME_STEP of Gymnasium)."""
        if not self._seeded:
            raise RuntimeError("step() before reset()")
        observations, rewards, terminated, truncated, last = self._core.step(np.asarray(actions, dtype=np.float64))
        infos: Dict[str, Any] = {}
        ended = terminated | truncated
        if ended.any():
            infos = {"final_obs": last, "_final_obs": ended}
        return observations, rewards, terminated, truncated, infos

    def close(self, **kwargs: Any) -> None:
        """Nothing is open."""


class HoverEnv(_Env):
    """One vehicle that hovers. Arguments as of HoverVectorEnv."""

    metadata: Dict[str, Any] = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, **arguments: Any) -> None:
        self._vector = HoverVectorEnv(1, threads=1, **arguments)
        self.action_space = self._vector.single_action_space
        self.observation_space = self._vector.single_observation_space
        self._ended = True

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[Floats, Dict[str, Any]]:
        """Begins an episode. Without a seed it goes on with the next one of its seed."""
        if USES_GYMNASIUM:
            super().reset(seed=seed)
        if seed is None and self._next is not None:
            observation = self._next
        else:
            observation = self._vector.reset(seed=seed)[0][0]
        self._next = None
        self._ended = False
        return observation, {}

    # The first observation of an episode that the core has begun with the end of the last one.
    _next: Optional[Floats] = None

    def step(self, action: ArrayLike) -> Tuple[Floats, float, bool, bool, Dict[str, Any]]:
        """Returns observation, reward, terminated, truncated, info. After an end, call reset()."""
        if self._ended:
            raise RuntimeError("step() before reset(): the episode has ended")
        observations, rewards, terminated, truncated, infos = self._vector.step(np.asarray(action, dtype=float)[np.newaxis])
        observation = observations[0]
        self._ended = bool(terminated[0] or truncated[0])
        if self._ended:
            self._next = observation
            observation = infos["final_obs"][0]
        return observation, float(rewards[0]), bool(terminated[0]), bool(truncated[0]), {}

    def close(self) -> None:
        """Nothing is open."""


def register() -> None:
    """Registers swiftlet/Hover-v0 in Gymnasium, for gymnasium.make() and make_vec(). Throws ImportError without it."""
    import gymnasium  # type: ignore[import]

    gymnasium.register(
        id="swiftlet/Hover-v0", entry_point="swiftlet.gym:HoverEnv", vector_entry_point="swiftlet.gym:HoverVectorEnv"
    )
