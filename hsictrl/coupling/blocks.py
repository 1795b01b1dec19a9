"""The occupied bridge taken apart: one named block per mode and per walker."""

from __future__ import annotations

from collections.abc import Sequence

import control as ct
import numpy as np

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.pedestrian import Crowd


def blocks_of(
    bridge: Footbridge, people: Crowd, rows: Array, drive: Array, inputs: Sequence[str],
) -> list[ct.StateSpace]:
    """Blocks whose signals meet by name: z[j], dz[j], ddz[j] of the modes, and contact force p[k] of the bodies."""
    contacts, n_fixed = [f"p[{k}]" for k in range(len(people))], len(bridge.absorbers)
    names = [f"absorber{k}" if k < n_fixed else f"walker{k - n_fixed}" for k in range(len(people))]
    modes = [_mode_block(bridge, j, np.concatenate([drive[:, j], rows[:, j]]), [*inputs, *contacts])
             for j in range(bridge.n_modes)]
    return modes + [_body_block(people, k, row, name) for k, (row, name) in enumerate(zip(rows, names, strict=True))]


def _mode_block(bridge: Footbridge, j: int, shares: Array, inputs: list[str]) -> ct.StateSpace:
    """A mode that weighs the forces at all points by its own shape there."""
    mode = bridge.modes[j].ss()
    return ct.ss(mode.A, mode.B * shares, mode.C, mode.D * shares, inputs=inputs, name=f"mode{j}",
                 outputs=[f"z[{j}]", f"dz[{j}]", f"ddz[{j}]"], states=mode.state_labels)


def _body_block(people: Crowd, k: int, row: Array, name: str) -> ct.StateSpace:
    """A body that feels all modes by their shapes where it stands."""
    body = people[k].ss()
    inputs = [f"{port}[{j}]" for port in ("z", "dz", "ddz") for j in range(len(row))]
    return ct.ss(body.A, np.kron(body.B, row), body.C, np.kron(body.D, row), inputs=inputs,
                 outputs=[f"p[{k}]"], states=body.state_labels, name=name)
