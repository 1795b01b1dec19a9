"""The compiled kernel: exponential Runge-Kutta steps of a bridge and those on it.

Modes and bodies are oscillators whose own motion is propagated exactly, under a forcing n that couples them. With
states z of the modes and u of the bodies,

    n_u = K φ·z + C φ·ż                                     the pull of the deck on a body, K = k/m₁, C = c/m₁
    n_z = z̈ + Γ ż + Ω² z,   M̄ z̈ = Σ φ [m₁(K u + C u̇ − n_u) + F] + f − Γ ż − Ω² z

so that nothing is solved but the n_m × n_m mass matrix M̄ = I + Σ m₀ φ φᵀ. The forcing is taken at four stages, and
interpolated in between by polynomials whose response is exact (Krogstad 2005, J. Comput. Phys. 203, 72–88; order
four). With every two steps of h goes one of 2h, which shares their shapes and forces and tells the error.

On a step in which somebody steps on or off the deck, φ is not smooth. Its values at the nodes of the step are then
those of the quadratic with the same first three moments over the step, which keeps the order.

Arrays of contacts run over n slots: those who are on the deck, and empty ones, whose φ is zero.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl._compiled import BORROWING, COMPILED, ONE, THREE, TWO
from hsictrl.walking.lines import spline

ROUNDING = 1e-6     # of a step, within which two times are one
NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
# values at 0, ½ and 1 of the quadratic q with given moments ∫ q τⁱ dτ over (0, 1), i = 0, 1, 2
FROM_MOMENTS = np.linalg.inv([[1 / 6, 2 / 3, 1 / 6], [0, 1 / 3, 1 / 6], [-1 / 60, 1 / 5, 3 / 20]])


class Contacts(NamedTuple):
    """Where bodies and forces meet the deck, one per slot; arrays may have more slots than are in use."""

    used: int         # slots in use, the first ones
    paths: Array      # (3, n): arrival, departure [s] and speed [m/s]
    shapes: Array     # (n, orders, n_m, points): φ along the deck and, for convective terms, v φ′ and v² φ″ [1/√kg, …]
    bodies: Array     # (4, n): K [1/s²], C [1/s], sprung and unsprung mass [kg]
    combs: Array      # (n, points + 4): forces, as in `ForceLines.tables` [N]
    periods: Array    # (2, n): comb periods per second [1/s], and table points in one


class Bridge(NamedTuple):
    """The modes, and how they and the bodies move alone."""

    length: float         # [m]
    modes: Array          # (2, n_m): Ω² [1/s²] and Γ [1/s]
    motions: Array        # (3, 7, n_m + n): `motion` over h/2, h and 2h


class Field(NamedTuple):
    """What acts at the nodes of a step."""

    rows: Array     # (nodes, orders, n_m, n): participations and their rates [1/√kg, …]
    force: Array    # (nodes, n): walking forces [N]
    load: Array     # (nodes, n_m): modal forces [N/√kg]
    root: Array     # (nodes, n_m, n_m): Cholesky factor of M̄


class Work(NamedTuple):
    """Scratch space."""

    y: Array               # (2, n_m + n): a stage
    n: Array               # (4, n_m + n): forcing at each stage
    acceleration: Array    # (2, n_m): z̈ at the beginning, and at later stages
    between: Array         # (n): place between two knots of a table
    knot: NDArray[np.int64]


@njit(cache=True, **COMPILED)     # its parts are inlined into it
def march(t, h, bridge, contacts, drive, fine, coarse, found, rough):  # type: ignore[no-untyped-def]
    """Go on from t by steps of h, and beside them by steps of 2h.

    drive : (4 pairs + 1, n_m), further modal forces at every half step of h
    fine, coarse : (2, n_m + n), positions and velocities of modes and bodies at t, moved on in place
    found : (2 pairs + 1, 3, n_m), filled with z, ż and z̈ at every step
    rough : (pairs + 1, 3, n_m), likewise, of the coarse road
    """
    orders, n_m, n = contacts.shapes.shape[1], drive.shape[1], contacts.used
    field, kept = _field(5, orders, n_m, n), _field(3, orders, n_m, n)
    work = Work(np.zeros((2, n_m + n)), np.zeros((4, n_m + n)), np.zeros((2, n_m)), np.zeros(n), np.zeros(n, np.int64))
    events = _events(contacts.paths)
    _shapes(t, 4, 0, n, bridge.length, contacts, field, work)
    _forces(t, 4, contacts, field, work)
    _sum(field, 4, drive, 0, contacts)
    for pair in range(len(rough) - 1):
        start, now = t + 2 * h * pair, 4 * pair
        _copy(field, 4, field, 0)
        _fill(start, h, bridge.length, contacts, events, field, work)
        for i in range(1, 5):
            _sum(field, i, drive, now + i, contacts)
        _go(start, h, 0, 1, bridge, contacts, events, drive, now, field, kept, fine, work, found, 2 * pair)
        _go(start + h, h, 2, 1, bridge, contacts, events, drive, now, field, kept, fine, work, found, 2 * pair + 1)
        _go(start, 2 * h, 0, 2, bridge, contacts, events, drive, now, field, kept, coarse, work, rough, pair)
    _record(field, 4, bridge, contacts, fine, work, found, len(found) - 1)
    _record(field, 4, bridge, contacts, coarse, work, rough, len(rough) - 1)


@njit(**COMPILED)
def _field(nodes, orders, n_m, n):  # type: ignore[no-untyped-def]
    return Field(np.zeros((nodes, orders, n_m, n)), np.zeros((nodes, n)), np.zeros((nodes, n_m)),
                 np.zeros((nodes, n_m, n_m)))


@njit(**BORROWING)
def _copy(source, i, target, j):  # type: ignore[no-untyped-def]
    """Node i of a field becomes node j of another."""
    _, orders, n_m, n = source.rows.shape
    for k in range(n):
        target.force[j, k] = source.force[i, k]
    for p in range(n_m):
        target.load[j, p] = source.load[i, p]
        for q in range(n_m):
            target.root[j, p, q] = source.root[i, p, q]
        for order in range(orders):
            for k in range(n):
                target.rows[j, order, p, k] = source.rows[i, order, p, k]


class Events(NamedTuple):
    """When somebody steps on or off, in order, and which slot it is."""

    times: Array
    slots: NDArray[np.intp]


@njit(**COMPILED)
def _events(paths):  # type: ignore[no-untyped-def]
    """All of a block."""
    times = paths[:2].copy().ravel()
    order = np.argsort(times)
    return Events(times[order], order % paths.shape[1])


@njit(**BORROWING)
def _within(events, t, h):  # type: ignore[no-untyped-def]
    """Events between t and t + h, both ends included: who comes at the end of a step is not there during the step.

    One step ends where the next begins but for rounding, in which nobody must get lost.
    """
    first, last = t - ROUNDING * h, t + (1 + ROUNDING) * h
    return range(np.searchsorted(events.times, first), np.searchsorted(events.times, last, side="right"))


@njit(**BORROWING)
def _fill(t, h, length, contacts, events, field, work):  # type: ignore[no-untyped-def]
    """Participations and forces at nodes 1 to 4, half a step of h apart."""
    rows = field.rows
    for i in range(1, 5):
        _forces(t + h / 2 * i, i, contacts, field, work)
    for i in (2, 4):
        _shapes(t + h / 2 * i, i, 0, rows.shape[3], length, contacts, field, work)
    # nobody goes far in half a step: on a deck of tens of metres, a parabola through every second node loses 1e-10
    for order in range(rows.shape[1]):
        for j in range(rows.shape[2]):
            for k in range(rows.shape[3]):
                a, b, c = rows[0, order, j, k], rows[2, order, j, k], rows[4, order, j, k]
                rows[1, order, j, k] = (3 * a + 6 * b - c) / 8
                rows[3, order, j, k] = (3 * c + 6 * b - a) / 8
    for event in _within(events, t, 2 * h):     # but for those who have just come, or gone
        k = events.slots[event]
        for i in (1, 3):
            _shapes(t + h / 2 * i, i, k, k + 1, length, contacts, field, work)


@njit(**BORROWING)
def _shapes(t, node, first, last, length, contacts, field, work):  # type: ignore[no-untyped-def]
    """Participations of a range of slots at time t."""
    rows, paths, tables = field.rows, contacts.paths, contacts.shapes
    _, orders, n_m, points = tables.shape
    for k in range(first, last):
        place = min(max(paths[2, k] * (t - paths[0, k]) / length, 0.0), 1.0) * (points - 1)
        nearest = min(max(int(place), 1), points - 3)
        work.between[k] = place - nearest
        work.knot[k] = nearest - 1
    for order in range(orders):
        for j in range(n_m):
            for k in range(first, last):
                i, table = np.uint64(work.knot[k]), tables[k, order, j]
                value = _cubic(table[i], table[i + ONE], table[i + TWO], table[i + THREE], work.between[k])
                rows[node, order, j, k] = value if (t >= paths[0, k]) & (t <= paths[1, k]) else 0.0


@njit(**BORROWING)
def _forces(t, node, contacts, field, work):  # type: ignore[no-untyped-def]
    """Walking forces at time t, of those off the deck too."""
    periods = contacts.periods
    for k in range(field.force.shape[1]):
        cycle = t * periods[0, k]
        place = (cycle - np.floor(cycle)) * periods[1, k]
        nearest = int(place)
        work.between[k] = place - nearest
        work.knot[k] = nearest
    for k in range(field.force.shape[1]):
        i, table = np.uint64(work.knot[k]), contacts.combs[k]
        field.force[node, k] = _spline(table[i], table[i + ONE], table[i + TWO], table[i + THREE], work.between[k])


_spline = njit(**BORROWING)(spline)


@njit(**BORROWING)
def _cubic(a, b, c, d, s):  # type: ignore[no-untyped-def]
    """The cubic through a, b, c and d at −1, 0, 1 and 2, at s."""
    return s * (s - 1) * ((s + 1) * d - (s - 2) * a) / 6 + (s + 1) * (s - 2) * ((s - 1) * b - s * c) / 2


@njit(**BORROWING)
def _shape(table, place):  # type: ignore[no-untyped-def]
    """A shape at a place in (0, 1) along the deck."""
    knot = place * (len(table) - 1)
    i = min(max(int(knot), 1), len(table) - 3)
    return _cubic(table[i - 1], table[i], table[i + 1], table[i + 2], knot - i)


@njit(**BORROWING)
def _sum(field, i, drive, now, contacts):  # type: ignore[no-untyped-def]
    """Modal forces and the factored mass matrix of node i, from its participations."""
    rows, root, unsprung = field.rows, field.root, contacts.bodies
    _, _, n_m, n = rows.shape
    for p in range(n_m):
        total = drive[now, p]
        for k in range(n):
            total += rows[i, 0, p, k] * field.force[i, k]
        field.load[i, p] = total
        for q in range(p + 1):
            total = 1.0 if p == q else 0.0
            for k in range(n):
                total += rows[i, 0, p, k] * unsprung[3, k] * rows[i, 0, q, k]
            for r in range(q):
                total -= root[i, p, r] * root[i, q, r]
            root[i, p, q] = np.sqrt(total) if p == q else total / root[i, q, q]


@njit(**BORROWING)
def _go(t, h, first, stride, bridge, contacts, events, drive, now, field, kept,  # type: ignore[no-untyped-def]
        x, work, found, at):
    """Record the state at t and take a step of h, over nodes first, first + stride and first + 2 stride."""
    late = _within(events, t, h)
    if not len(late):
        _keep(x, found, at)
        _step(h, field, first, stride, stride, bridge, contacts, x, work)
        for j in range(found.shape[2]):
            found[at, 2, j] = work.acceleration[0, j]
        return
    _record(field, first, bridge, contacts, x, work, found, at)
    for i in range(3):
        _copy(field, first + i * stride, kept, i)
    for event in late:
        _smooth(t, h, events.slots[event], bridge.length, contacts, kept.rows)
    for i in range(3):
        _sum(kept, i, drive, now + first + i * stride, contacts)
    _step(h, kept, 0, 1, stride, bridge, contacts, x, work)


@njit(**BORROWING)
def _smooth(t, h, k, length, contacts, rows):  # type: ignore[no-untyped-def]
    """Nodal values of slot k that keep the moments of its shapes over a step in which it steps on or off."""
    arrival, departure, speed = contacts.paths[0, k], contacts.paths[1, k], contacts.paths[2, k]
    start, half = max(t, arrival), max(0.0, min(t + h, departure) - max(t, arrival)) / 2
    for order in range(rows.shape[1]):
        for j in range(rows.shape[2]):
            zeroth = first = second = 0.0
            for i in range(len(NODES)):
                at = start + half * (1 + NODES[i])
                part = WEIGHTS[i] * half / h * _shape(contacts.shapes[k, order, j], speed * (at - arrival) / length)
                zeroth += part
                first += part * (at - t) / h
                second += part * ((at - t) / h) ** 2
            for i in range(3):
                of = FROM_MOMENTS[i]
                rows[i, order, j, k] = of[0] * zeroth + of[1] * first + of[2] * second


@njit(**BORROWING)
def _keep(x, found, at):  # type: ignore[no-untyped-def]
    """Record displacements and velocities of the modes."""
    for j in range(found.shape[2]):
        found[at, 0, j], found[at, 1, j] = x[0, j], x[1, j]


@njit(**BORROWING)
def _record(field, i, bridge, contacts, x, work, found, at):  # type: ignore[no-untyped-def]
    """Record the state at node i, accelerations with it."""
    _keep(x, found, at)
    _force(field, i, bridge, contacts, x, work, 0)
    for j in range(found.shape[2]):
        found[at, 2, j] = work.acceleration[0, j]


@njit(**BORROWING)
def _step(h, field, first, stride, road, bridge, contacts, x, work):  # type: ignore[no-untyped-def]
    """One step, from the state x on, on the fine road (1) or the coarse one (2). Leaves z̈ at its beginning in `work`.

    Rows of motions, over half a step and a whole one: 0 to 3 free motion, 4 to 6 what forcings 1, τ and τ² come to,
    τ = t over the length. Forced velocities follow by parts: row 1, row 4 and twice row 5, over the length.
    """
    y, n, half, whole = work.y, work.n, bridge.motions[road - 1], bridge.motions[road]
    _force(field, first, bridge, contacts, x, work, 0)
    for k in range(y.shape[1]):
        y[0, k] = half[0, k] * x[0, k] + half[1, k] * x[1, k] + half[4, k] * n[0, k]
        y[1, k] = half[2, k] * x[0, k] + half[3, k] * x[1, k] + half[1, k] * n[0, k]
    _force(field, first + stride, bridge, contacts, y, work, 1)
    _lean(h / 2, half, x, n[0], n[1], y)
    _force(field, first + stride, bridge, contacts, y, work, 2)
    _lean(h, whole, x, n[0], n[2], y)
    _force(field, first + 2 * stride, bridge, contacts, y, work, 3)
    for k in range(y.shape[1]):     # n is n₀ + a τ + b τ², through both values in the middle
        middle = 2 * (n[1, k] + n[2, k])
        a, b = middle - 3 * n[0, k] - n[3, k], 2 * (n[0, k] + n[3, k]) - middle
        position = whole[0, k] * x[0, k] + whole[1, k] * x[1, k]
        velocity = whole[2, k] * x[0, k] + whole[3, k] * x[1, k]
        x[0, k] = position + whole[4, k] * n[0, k] + whole[5, k] * a + whole[6, k] * b
        x[1, k] = velocity + whole[1, k] * n[0, k] + whole[4, k] * (a / h) + whole[5, k] * (2 * b / h)


@njit(**BORROWING)
def _lean(time, over, x, first, middle, y):  # type: ignore[no-untyped-def]
    """The next stage y: under a forcing that goes linearly from its first value through the one in the middle."""
    for k in range(y.shape[1]):
        slope = 2 * (middle[k] - first[k])
        position = over[0, k] * x[0, k] + over[1, k] * x[1, k]
        velocity = over[2, k] * x[0, k] + over[3, k] * x[1, k]
        y[0, k] = position + over[4, k] * first[k] + over[5, k] * slope
        y[1, k] = velocity + over[1, k] * first[k] + over[4, k] * (slope / time)


@njit(**BORROWING)
def _force(field, i, bridge, contacts, x, work, stage):  # type: ignore[no-untyped-def]
    """Modal accelerations at node i of a field, and the forcing n of modes and bodies that move alone otherwise."""
    rows, modes, bodies, n, found = field.rows[i], bridge.modes, contacts.bodies, work.n[stage], work.acceleration
    n_m, at = modes.shape[1], min(stage, 1)
    pull, u, du = n[n_m:], x[0, n_m:], x[1, n_m:]
    stiffness, damping, sprung, unsprung = bodies[0], bodies[1], bodies[2], bodies[3]
    pull[:] = 0.0
    for j in range(n_m):
        row, z, dz = rows[0, j], x[0, j], x[1, j]
        for k in range(len(pull)):
            pull[k] += row[k] * (stiffness[k] * z + damping[k] * dz)
    if len(rows) > 1:      # convective: the contact moves along the shape
        for j in range(n_m):
            for k in range(len(pull)):
                pull[k] += damping[k] * rows[1, j, k] * x[0, j]
    for j in range(n_m):
        row, total = rows[0, j], field.load[i, j] - modes[0, j] * x[0, j] - modes[1, j] * x[1, j]
        for k in range(len(pull)):
            total += row[k] * sprung[k] * (stiffness[k] * u[k] + damping[k] * du[k] - pull[k])
        if len(rows) > 1:
            for q in range(n_m):
                for k in range(len(pull)):
                    total -= row[k] * unsprung[k] * (2 * rows[1, q, k] * x[1, q] + rows[2, q, k] * x[0, q])
        found[at, j] = total
    _solve(field.root, i, found, at)
    for j in range(n_m):
        n[j] = found[at, j] + modes[0, j] * x[0, j] + modes[1, j] * x[1, j]


@njit(**BORROWING)
def _solve(root, i, b, at):  # type: ignore[no-untyped-def]
    """Solve for row `at` of b in place, with the Cholesky factor of node i."""
    n_m = b.shape[1]
    for p in range(n_m):
        for q in range(p):
            b[at, p] -= root[i, p, q] * b[at, q]
        b[at, p] /= root[i, p, p]
    for p in range(n_m - 1, -1, -1):
        for q in range(p + 1, n_m):
            b[at, p] -= root[i, q, p] * b[at, q]
        b[at, p] /= root[i, p, p]
