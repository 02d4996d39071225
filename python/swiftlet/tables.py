"""Columns of recorded flights as tables."""
import csv
import os
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Union

import numpy as np
from numpy.typing import NDArray

from . import _core

if TYPE_CHECKING:
    import pandas  # type: ignore[import]

Column = Union[NDArray[Any], List[str]]


def read_flight_csv(path: Union[str, "os.PathLike[str]"]) -> Dict[str, Column]:
    """The columns of flight.csv of a flight record, by their names with units: 't [s]', 'x_ned [m]'; docs/csv.md lists them.

    Numbers are float64, NaN where a cell is empty; 'mode' is a list of texts. A folder stands for the flight.csv in it. Throws
    InputError.
    """
    file = os.path.join(path, "flight.csv") if os.path.isdir(path) else os.fspath(path)
    try:
        with open(file, newline="", encoding="utf-8") as text:
            rows = list(csv.reader(text))
    except OSError as error:
        raise _core.InputError(f"{file}: {error.strerror}") from None
    if not rows or "mode" not in rows[0]:
        raise _core.InputError(f"{file}: is no flight.csv of a flight record: it has no column 'mode'")
    names = rows[0]
    columns: Dict[str, Column] = {}
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(names):
            raise _core.InputError(f"{file}:{number}: has {len(row)} cells, must have {len(names)}")
    for index, name in enumerate(names):
        cells = [row[index] for row in rows[1:]]
        if name == "mode":
            columns[name] = cells
            continue
        try:
            columns[name] = np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError as error:
            raise _core.InputError(f"{file}: {name}: {error}") from None
    return columns


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
