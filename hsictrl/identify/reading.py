"""A record as times and signals, however it is given."""

from __future__ import annotations

import control as ct
import numpy as np
from numpy.typing import ArrayLike

from hsictrl import _checks as check
from hsictrl._checks import Array


def signals(record: ct.TimeResponseData | ArrayLike, timepts: ArrayLike | None) -> tuple[Array, Array]:
    """Times, shape (m,), and one row per output, shape (p, m)."""
    given, times = _parts(record, timepts)
    outputs = check.numbers("record", given, remedy="cut or fill what was not measured")
    time = check.even_times("times of a record", times)
    rows = np.atleast_2d(outputs)
    if rows.ndim > 2 or rows.shape[-1] != len(time):
        raise ValueError(f"record must hold one value per output and time, got shape {outputs.shape} for {len(time)} "
                         "times; give one trace, and all its times")
    return time, rows


def _parts(record: ct.TimeResponseData | ArrayLike, timepts: ArrayLike | None) -> tuple[ArrayLike, ArrayLike]:
    if isinstance(record, ct.TimeResponseData):
        if timepts is not None:
            raise TypeError("timepts must go with an array, got them with a TimeResponseData; leave them out")
        return record.outputs, record.time
    if timepts is None:
        raise TypeError(f"timepts must go with an array, got none with a {type(record).__name__}; give seconds")
    return record, timepts
