"""Columns of recorded flights as tables."""
from typing import TYPE_CHECKING, Any, Dict, Mapping

import numpy as np

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

def to_pandas(columns: Mapping[str, Any]) -> "pandas.DataFrame":
    """A table of columns as read_mcap(), Flight.truth() and the others return them; needs pandas.

    An array of several columns becomes 'position_ned[0]', 'position_ned[1]' ... Columns of another length than the first, and
    values that are no columns, are left out.
    """
    import pandas

    flat: Dict[str, Any] = {}
    rows = -1
    for name, values in columns.items():
        if not isinstance(values, (np.ndarray, list)):
            continue
        rows = len(values) if rows < 0 else rows
        if len(values) != rows:
            continue
        if isinstance(values, np.ndarray) and values.ndim == 2:
            flat.update({f"{name}[{i}]": values[:, i] for i in range(values.shape[1])})
        else:
            flat[name] = values
    return pandas.DataFrame(flat)
