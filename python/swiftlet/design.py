"""The control design with its gains and margins."""
import json
from typing import Any, Dict, Union

from . import _core


def gains(
    vehicle: Union[str, _core.VehicleModel] = "kaylion",
    control: Union[str, _core.ControlSettings] = "motor_lag",
    *,
    samples: int = 1000,
    seed: int = 1,
) -> Dict[str, Any]:
    """The gains, poles and margins of LQR and RPT for a vehicle and control settings, as `swiftlet gains --json` prints them.

    vehicle, control: names of files, their paths, or objects. The margins are also those of `samples` vehicles drawn from the
    uncertainty of a vehicle file; an object has none. Keys:

    - rotor_lag_s: tau_m of Eq. (18)
    - attitude.{roll,pitch,yaw}: model, q, r, k, poles and poles_with_motor_lag ([re, im], rad/s), phase_margin_deg
    - position.{x,y,z}: omega_n, zeta, epsilon, integral_pole, f of Eq. (49), integral_form, poles, phase_margin_deg
    - margins.{roll,pitch,yaw,x,y,z}.{designed,most,worst}: phase_deg, gain_increase_db, gain_decrease_db, delay_s;
      None: no such change makes the loop unstable
    - flown_delay_s.{roll,...}: the least delay that makes the loop unstable, with the observers of the estimator
    - samples, seed, unstable: number of samples, seed of the first, number of samples with an unstable loop

    Throws InputError.
    """
    report: Dict[str, Any] = json.loads(_core.gains_json(vehicle, control, samples=samples, seed=seed))
    return report
