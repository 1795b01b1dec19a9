"""A bridge as a block: forces in, motion out, with whatever is fixed to it inside the loop."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.pedestrian import Crowd

PORTS = 3     # y, v and a


def plant(omega: Array, damping: Array, rows: Array) -> ct.StateSpace:
    """Modes with a port at every row of participations: forces in, y, v and a of each point out (eqs. 5–8, 12)."""
    n, n_m = rows.shape
    zero, eye = np.zeros((n_m, n_m)), np.eye(n_m)
    A = np.block([[zero, eye], [-np.diag(omega**2), -np.diag(2 * damping * omega)]])
    B = np.vstack([np.zeros((n_m, n)), rows.T])
    motion = np.stack([rows @ np.hstack([eye, zero]), rows @ np.hstack([zero, eye]), rows @ A[n_m:]], axis=1)
    direct = np.stack([np.zeros((n, n)), np.zeros((n, n)), rows @ rows.T], axis=1)
    return ct.ss(A, B, motion.reshape(n * PORTS, -1), direct.reshape(n * PORTS, -1))


def block(
    omega: Array, damping: Array, rows: Array, fixed: Crowd, fixed_rows: Array, ports: Sequence[str], name: str,
) -> ct.StateSpace:
    """The plant with named signals; bodies that are fixed to it close the loop around the last of its ports."""
    n, n_m = rows.shape
    whole = plant(omega, damping, np.vstack([rows, fixed_rows]))
    if len(fixed):
        whole = whole.lft(fixed.ss(), len(fixed), PORTS * len(fixed))
    kept = (PORTS * np.arange(n)[:, None] + np.arange(len(ports))).ravel()
    return ct.ss(whole.A, whole.B, whole.C[kept], whole.D[kept], inputs=labels("F", n), outputs=labels(ports, n),
                 states=labels("z", n_m) + labels("dz", n_m) + labels(("u", "du"), len(fixed)), name=name)
