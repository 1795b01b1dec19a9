"""What pyOMA-2 finds in a record: poles of models of rising order, with standard deviations."""

from __future__ import annotations

import io
import logging
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array


class Poles(NamedTuple):
    """Stable poles, one of each conjugate pair, those of all orders behind one another; shapes (n,) and (n, p)."""

    order: NDArray[np.intp]
    frequency: Array
    frequency_error: Array
    damping: Array
    damping_error: Array
    shape: NDArray[np.complex128]


def poles(signals: Array, rate: float, references: list[int], *, highest_order: int, rows: int, blocks: int) -> Poles:
    """Poles at the even orders, by covariance-driven subspace identification with reference channels (SSI-cov/ref).

    Standard deviations are those of Döhler and Mevel (2013): the scatter of the covariances between `blocks` of the
    record goes to first order through all that follows. They need a step of one through the orders (pyOMA-2 1.4).
    """
    setup, algorithm = _pyoma()
    identification = algorithm(
        name="SSI-cov/ref", method="cov", br=rows, ref_ind=references, ordmax=highest_order, step=1,
        calc_unc=True, nb=blocks, hc={"xi_max": 1.0, "mpc_lim": None, "mpd_lim": None, "CoV_max": None})
    measured = setup(signals.T, rate)
    measured.add_algorithms(identification)
    try:
        with _quiet():
            measured.run_all()
    except np.linalg.LinAlgError:
        raise ValueError("record must be a random vibration at every sensor, got covariances that are singular; leave "
                         "out copies of a signal, and cut what is a pure tone or a blow") from None
    return _even_orders(identification.result)


def _even_orders(found: Any) -> Poles:
    """A mode is a pair of poles, so an odd order holds half a mode."""
    known = np.isfinite(found.Fn_poles_std) & np.isfinite(found.Xi_poles_std)
    known[:, 1::2] = False
    order = np.nonzero(known)[1]
    return Poles(order, found.Fn_poles[known], found.Fn_poles_std[known], found.Xi_poles[known],
                 found.Xi_poles_std[known], found.Phi_poles[known])


def _pyoma() -> tuple[Any, Any]:
    """The classes of pyOMA-2, imported when first asked for: that takes longer than an identification.

    On import it silences warnings of NumPy and the log of matplotlib for good, which is undone here.
    """
    drawing = logging.getLogger("matplotlib")
    level = drawing.level
    try:
        with np.errstate():
            from pyoma2.algorithms import SSI
            from pyoma2.setup import SingleSetup
    except ImportError:
        raise ImportError("subspace_identification must find pyOMA-2, got none; pip install 'hsictrl[oma]'") from None
    finally:
        drawing.setLevel(level)
    return SingleSetup, SSI


@contextmanager
def _quiet() -> Iterator[None]:
    """No log, no progress bars, and no warnings where a pole is none."""
    log = logging.getLogger("pyoma2")
    level = log.level
    log.setLevel(logging.ERROR)
    try:
        with np.errstate(all="ignore"), redirect_stderr(io.StringIO()):
            yield
    finally:
        log.setLevel(level)
