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
import copy
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

    def _mode_of(value: str) -> Any:
        ...

else:
    try:
        from gymnasium import Env as _Env
        from gymnasium.spaces import Box as _GymnasiumBox
        from gymnasium.vector import AutoresetMode as _mode_of
        from gymnasium.vector import VectorEnv as _VectorEnv

        USES_GYMNASIUM = True

        def Box(low, high):
            return _GymnasiumBox(low, high, dtype=np.float64)

    except ImportError:
        from .spaces import Box

        USES_GYMNASIUM = False
        _mode_of = str

        class _Env:
            pass

        class _VectorEnv:
            pass


Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_MODES = ("SameStep", "NextStep", "Disabled")  # the values of Gymnasium's AutoresetMode


def _random_seed() -> int:
    return int.from_bytes(os.urandom(8), "little") >> 1


def _made(kind: Any, arguments: Dict[str, Any]) -> Any:
    return kind(**arguments)


class HoverVectorEnv(_VectorEnv):
    """Many vehicles that hover, each by itself. Shapes have the number of environments in front."""

    metadata: Dict[str, Any] = {"render_modes": [], "autoreset_mode": _mode_of("SameStep")}
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
        autoreset_mode: Any = "SameStep",
        **task: Any,
    ) -> None:
        """threads: 0: one for each core. vehicle, simulation: names of files, their paths, or objects. dispersion: a file, or
        "uncertainty" of the vehicle file. autoreset_mode: of Gymnasium, "SameStep", "NextStep" or "Disabled". task:
        action_period_s, episode_s, target_ned, radius_m, start_distance_m, start_speed_m_s, start_tilt_rad, start_rate_rad_s,
        and the bounds max_rate_rad_s, max_tilt_rad, max_speed_m_s and max_yaw_rate_rad_s; docs/python.md has their defaults.
        Throws swiftlet.InputError."""
        self._mode = str(getattr(autoreset_mode, "value", autoreset_mode))
        if self._mode not in _MODES:
            raise _core.InputError(f"autoreset_mode is {self._mode}, must be {', '.join(_MODES[:2])} or {_MODES[2]}")
        self.metadata = {**self.metadata, "autoreset_mode": _mode_of(self._mode)}
        made_of: Dict[str, Any] = dict(
            level=level, threads=threads, vehicle=vehicle, simulation=simulation, dispersion=dispersion, **task
        )
        self._core = _core.HoverEnvironments(num_envs, **made_of)
        self._made_of = {"num_envs": num_envs, "autoreset_mode": self._mode, **made_of}
        self.num_envs = num_envs
        # Whose episode has ended, and the last observations. The core has begun the next one already.
        self._ended = np.zeros(num_envs, dtype=bool)
        self._last: Optional[Floats] = None
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
        """Begins an episode in all environments, or in those of options["reset_mask"], bool of shape (num_envs,). seed:
        environment i has seed + i, or its own of a sequence; without a seed they go on with the next episode of theirs, and
        before the first one have seeds of the operating system."""
        chosen = np.asarray((options or {}).get("reset_mask", np.ones(self.num_envs, dtype=bool)))
        if chosen.dtype != bool or chosen.shape != (self.num_envs,):
            raise _core.InputError(f"reset_mask must be bool of shape ({self.num_envs},)")
        if not self._seeded and not chosen.all():
            raise RuntimeError("reset() of some environments before reset() of all")
        seeds: Optional[List[int]] = None
        if isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + i for i in range(self.num_envs)]
        elif seed is not None:
            seeds = [_random_seed() if one is None else int(one) for one in seed]
        elif not self._seeded:
            seeds = [_random_seed() for _ in range(self.num_envs)]
        if seeds is not None and min(seeds) < 0:
            raise _core.InputError(f"seed is {min(seeds)}, must be at least 0")
        if seeds is None:
            observations = self._core.reset(chosen=chosen & ~self._ended)
        else:
            observations = self._core.reset(np.array(seeds, dtype=np.uint64), chosen)
        self._seeded = True
        self._ended = self._ended & ~chosen
        if self._last is not None:
            observations[self._ended] = self._last[self._ended]
        return observations, {}

    def step(self, actions: ArrayLike) -> Tuple[Floats, Floats, Flags, Flags, Dict[str, Any]]:
        """Returns observations, rewards, terminated, truncated, infos. Where an episode ends, by autoreset mode,

        - SameStep: the next one begins in the same step: its row of the observations is the first of that, and
          infos["final_obs"] has the last one, with infos["_final_obs"] true there;
        - NextStep: the next one begins with the next step, whose action is ignored and whose reward is 0;
        - Disabled: call reset(options={"reset_mask": terminated | truncated}) before the next step."""
        if not self._seeded:
            raise RuntimeError("step() before reset()")
        if self._mode == "Disabled" and self._ended.any():
            raise RuntimeError("step() before reset(): an episode has ended")
        actions = np.asarray(actions, dtype=np.float64)
        observations, rewards, terminated, truncated, last = self._core.step(actions, ~self._ended)
        infos: Dict[str, Any] = {}
        ended = terminated | truncated
        if self._mode != "SameStep":
            observations[ended] = last[ended]
            self._ended, self._last = ended, last
        elif ended.any():
            infos = {"final_obs": last, "_final_obs": ended}
        return observations, rewards, terminated, truncated, infos

    def __reduce__(self) -> Tuple[Any, ...]:
        """Pickles what it was made of, without the state of its episodes: call reset(). copy.deepcopy() copies that too."""
        return _made, (type(self), self._made_of)

    def __deepcopy__(self, memo: Dict[int, Any]) -> "HoverVectorEnv":
        copied = type(self).__new__(type(self))
        memo[id(self)] = copied
        copied.__dict__.update({name: copy.deepcopy(value, memo) for name, value in self.__dict__.items()})
        return copied

    def close(self, **kwargs: Any) -> None:
        """Nothing is open."""


class HoverEnv(_Env):
    """One vehicle that hovers. Arguments as of HoverVectorEnv."""

    metadata: Dict[str, Any] = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, **arguments: Any) -> None:
        self._vector = HoverVectorEnv(1, threads=1, autoreset_mode="Disabled", **arguments)
        self.action_space = self._vector.single_action_space
        self.observation_space = self._vector.single_observation_space

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Dict[str, Any]] = None
    ) -> Tuple[Floats, Dict[str, Any]]:
        """Begins an episode. Without a seed it goes on with the next one of its seed."""
        if USES_GYMNASIUM:
            super().reset(seed=seed)
        return self._vector.reset(seed=seed)[0][0], {}

    def step(self, action: ArrayLike) -> Tuple[Floats, float, bool, bool, Dict[str, Any]]:
        """Returns observation, reward, terminated, truncated, info. After an end, call reset()."""
        observations, rewards, terminated, truncated, _ = self._vector.step(np.asarray(action, dtype=float)[np.newaxis])
        return observations[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), {}

    def close(self) -> None:
        """Nothing is open."""


def register() -> None:
    """Registers swiftlet/Hover-v0 in Gymnasium, for gymnasium.make() and make_vec(). Throws ImportError without it."""
    import gymnasium  # type: ignore[import]

    gymnasium.register(
        id="swiftlet/Hover-v0", entry_point="swiftlet.gym:HoverEnv", vector_entry_point="swiftlet.gym:HoverVectorEnv"
    )
