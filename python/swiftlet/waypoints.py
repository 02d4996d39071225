"""Missions of arrays."""
import json
from typing import Any, Dict, List, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core

LANDING_SPEED_M_S = 0.3


def waypoint_mission(
    positions_ned_m: ArrayLike,
    *,
    speed_m_s: float = 0.5,
    hold_s: float = 0.0,
    tolerance_m: float = 0.1,
    name: str = "waypoints",
    control: Union[str, _core.ControlSettings] = "motor_lag",
) -> _core.Mission:
    """A mission that takes off to the height of the first position, flies straight from each to the next, stops there for
    hold_s, and lands at the last one.

    positions_ned_m: shape (n, 3), m north, east and down of the origin: 1 m up is -1. tolerance_m: largest peak error of a
    completed flight. control: whose limits it is checked by. Throws InputError.
    """
    positions = np.asarray(positions_ned_m, dtype=float)
    if positions.ndim != 2 or positions.shape[1] != 3 or len(positions) == 0:
        raise _core.InputError(f"positions_ned_m has shape {positions.shape}, must be (n, 3) with n of at least 1")
    if not np.isfinite(positions).all():
        raise _core.InputError("positions_ned_m has numbers that are not finite")
    items: List[Dict[str, Any]] = [{"kind": "takeoff", "height_m": float(-positions[0, 2]), "speed_m_s": speed_m_s}]
    items += [
        {"kind": "waypoint", "position_m": position.tolist(), "speed_m_s": speed_m_s, "hold_s": hold_s}
        for position in positions
    ]
    items.append({"kind": "land", "speed_m_s": LANDING_SPEED_M_S})
    mission = {"name": name, "frame": "ned", "tolerance_m": tolerance_m, "items": items}
    return _core.parse_mission(json.dumps(mission) + "\n", control, name)
