"""`control.interconnect` with algebraic loops closed exactly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final

import control as ct
import numpy as np
from scipy.linalg import block_diag

from hsictrl import _checks as check
from hsictrl._checks import Array


@final
class ExactICSystem(ct.LinearICSystem):
    """An interconnection that is simulated and linearised by its closed-loop matrices, not by the host's sweeps."""

    def _rhs(self, t: float, x: Array, u: Array) -> Array:
        return np.asarray(self.A @ np.ravel(x) + self.B @ np.ravel(u))

    def _out(self, t: float, x: Array, u: Array) -> Array:
        return np.asarray(self.C @ np.ravel(x) + self.D @ np.ravel(u))


def interconnect(
    syslist: Sequence[Any], connections: Any = None, inplist: Any = None, outlist: Any = None,
    params: dict[str, Any] | None = None, check_unused: bool = True, add_unused: bool = False,
    ignore_inputs: Any = None, ignore_outputs: Any = None, warn_duplicate: bool | None = None,
    debug: bool = False, **kwargs: Any,
) -> ct.InterconnectedSystem:
    """Interconnect systems as `control.interconnect` does; where all are linear, close every loop exactly.

    The host evaluates the loop by sweeping through the blocks, and refuses systems with an
    algebraic loop, such as a body with unsprung mass makes. Here the loop is solved:
    E = (I − K D)⁻¹ with the connection map K, A′ = A + B E K C, and so on.

    Parameters
    ----------
    syslist : list of control systems
        The blocks.
    connections, inplist, outlist : list, optional
        Connections between blocks, and of blocks to the outside; by signal name if not given.
    params : dict, optional
        Parameter values for nonlinear blocks.
    check_unused, add_unused : bool
        Whether to warn of unused signals, and whether to lead them outside.
    ignore_inputs, ignore_outputs : list, optional
        Signals known to be unused.
    warn_duplicate : bool, optional
        Whether to warn of duplicate names.
    debug : bool
        Whether to print how signals are processed.
    **kwargs
        `inputs`, `outputs`, `states`, `name`, `dt` and prefixes, as the host takes them; the host
        refuses any other.

    Returns
    -------
    control.LinearICSystem or control.InterconnectedSystem
        Linear if every block is.

    Raises
    ------
    ValueError
        If an algebraic loop has no solution; the message names its signals.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.pedestrian import Pedestrian
    >>> loop = interconnect([reference_bridge(frequency=2.0).ss(at=[25.0]), Pedestrian().ss()],
    ...     connections=[["walker.y", "bridge.y"], ["walker.v", "bridge.v"], ["walker.a", "bridge.a"],
    ...                  ["bridge.F", "walker.F"]],
    ...     inplist=["bridge.F"], outlist=["bridge.a"])
    >>> loop.nstates
    4
    """
    for block in check.instance("syslist", syslist, Sequence, "give a list of control systems"):
        check.instance("syslist", block, ct.InputOutputSystem, "give a list of control systems")
    stand_ins = _without_linearity(syslist)
    joined = ct.interconnect(
        stand_ins, connections=connections, inplist=inplist, outlist=outlist, params=params,
        check_unused=check_unused, add_unused=add_unused, ignore_inputs=ignore_inputs,
        ignore_outputs=ignore_outputs, warn_duplicate=warn_duplicate, debug=debug, **kwargs)
    joined.syslist = [_state_space(block) for block in syslist]
    if not joined.syslist or not all(isinstance(block, ct.StateSpace) for block in joined.syslist):
        return joined
    return ExactICSystem(joined, ct.ss(*_closed(joined), joined.dt), connection_type=joined.connection_type)


def _without_linearity(syslist: Sequence[Any]) -> list[Any]:
    """Blocks of the same names and sizes that the host does not linearise; the same block stays the same."""
    stand_ins = {id(block): _stand_in(block) for block in syslist}
    return [stand_ins[id(block)] for block in syslist]


def _stand_in(block: Any) -> Any:
    block = _state_space(block)
    return ct.nlsys(block, name=block.name, dt=block.dt) if isinstance(block, ct.StateSpace) else block


def _state_space(block: Any) -> Any:
    return ct.ss(block, name=block.name) if isinstance(block, ct.TransferFunction) else block


def _closed(joined: ct.InterconnectedSystem) -> tuple[Array, Array, Array, Array]:
    """Matrices of the closed loop from the host's own maps."""
    A, B, C, D = (block_diag(*(getattr(block, part) for block in joined.syslist)) for part in "ABCD")
    K, U = joined.connect_map, joined.input_map
    from_outputs, from_inputs = np.split(joined.output_map, [len(C)], axis=1)
    loop = np.eye(len(K)) - K @ D
    _refuse_ill_posed(loop, joined)
    inner, outer = np.linalg.solve(loop, K @ C), np.linalg.solve(loop, U)
    return (A + B @ inner, B @ outer,
            from_outputs @ (C + D @ inner) + from_inputs @ inner,
            from_outputs @ D @ outer + from_inputs @ outer)


def _refuse_ill_posed(loop: Array, joined: ct.InterconnectedSystem) -> None:
    if not len(loop):
        return
    before, sizes, after = np.linalg.svd(loop)
    if sizes[-1] > len(loop) * np.finfo(float).eps * sizes[0]:
        return
    names = [f"{block.name}.{label}" for block in joined.syslist for label in block.input_labels]
    shares = np.abs(before[:, -1] * after[-1])       # upstream and downstream of the loop, one of them is zero
    caught = [name for name, share in zip(names, shares, strict=True) if share > 1e-6 * shares.max()]
    raise ValueError(f"an algebraic loop must have a solution, got none through {', '.join(caught)}; "
                     "break it with dynamics, or change a gain on it")
