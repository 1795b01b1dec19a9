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

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.walking.lines import spline

# the sums may be taken in any order: only so do the loops over slots run on vectors
COMPILED: dict[str, Any] = {
    "cache": True, "nogil": True, "error_model": "numpy", "fastmath": {"reassoc", "contract", "nsz", "arcp"}}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(5)
ONE, TWO, THREE = np.uint64(1), np.uint64(2), np.uint64(3)      # unsigned, or every index is checked for its sign
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
    weights: Array        # (2, 24, n_m + n): `step_weights` for steps of h and 2h


class Field(NamedTuple):
    """What acts at the nodes of a step."""

    rows: Array    # (nodes, orders, n_m, n): participations and their rates [1/√kg, …]
    load: Array    # (nodes, n_m): modal forces [N/√kg]
    root: Array    # (nodes, n_m, n_m): Cholesky factor of M̄


class Work(NamedTuple):
    """Scratch space."""

    y: Array               # (2, n_m + n): a stage
    n: Array               # (4, n_m + n): forcing at each stage
    acceleration: Array    # (n_m)
    between: Array         # (n): place between two knots of a table
    knot: NDArray[np.int64]


@njit(**COMPILED)
def march(t, h, bridge, contacts, drive, fine, coarse, found, rough):  # type: ignore[no-untyped-def]
    """Go on from t by steps of h, and beside them by steps of 2h.

    drive : (4 pairs + 1, n_m), further modal forces at every half step of h
    fine, coarse : (2, n_m + n), positions and velocities of modes and bodies at t, moved on in place
    found : (2 pairs + 1, 3, n_m), filled with z, ż and z̈ at every step
    rough : (pairs + 1, 3, n_m), likewise, of the coarse road
    """
    orders, n_m, n = contacts.shapes.shape[1], drive.shape[1], contacts.used
    field = Field(np.zeros((5, orders, n_m, n)), np.zeros((5, n_m)), np.zeros((5, n_m, n_m)))
    kept = Field(np.zeros((3, orders, n_m, n)), np.zeros((3, n_m)), np.zeros((3, n_m, n_m)))
    work = Work(np.zeros((2, n_m + n)), np.zeros((4, n_m + n)), np.zeros(n_m), np.zeros(n), np.zeros(n, np.int64))
    force = np.zeros((5, n))
    events = _events(contacts.paths)
    _shapes(t, 0, n, bridge.length, contacts, field.rows[4], work.between, work.knot)
    _forces(t, contacts, force[4], work.between, work.knot)
    _sum(field, 4, drive[0], contacts.bodies[3], force[4])
    for pair in range(len(rough) - 1):
        start = t + 2 * h * pair
        field.rows[0], field.load[0], field.root[0], force[0] = field.rows[4], field.load[4], field.root[4], force[4]
        _fill(start, h, bridge.length, contacts, events, field, force, work)
        for i in range(1, 5):
            _sum(field, i, drive[4 * pair + i], contacts.bodies[3], force[i])
        share = drive[4 * pair:4 * pair + 5]
        _go(start, h, 0, 1, bridge, contacts, events, share, field, kept, force, fine, work, found[2 * pair])
        _go(start + h, h, 2, 1, bridge, contacts, events, share, field, kept, force, fine, work, found[2 * pair + 1])
        _go(start, 2 * h, 0, 2, bridge, contacts, events, share, field, kept, force, coarse, work, rough[pair])
    _record(field, 4, bridge, contacts, fine, work, found[-1])
    _record(field, 4, bridge, contacts, coarse, work, rough[-1])


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


@njit(**COMPILED)
def _within(events, t, h):  # type: ignore[no-untyped-def]
    """Slots that step on or off between t and t + h."""
    return events.slots[np.searchsorted(events.times, t, side="right"):np.searchsorted(events.times, t + h)]


@njit(**COMPILED)
def _fill(t, h, length, contacts, events, field, force, work):  # type: ignore[no-untyped-def]
    """Participations and forces at nodes 1 to 4, half a step of h apart."""
    rows = field.rows
    for i in range(1, 5):
        _forces(t + h / 2 * i, contacts, force[i], work.between, work.knot)
    for i in (2, 4):
        _shapes(t + h / 2 * i, 0, rows.shape[3], length, contacts, rows[i], work.between, work.knot)
    # nobody goes far in half a step: a parabola through every second node loses 1e-10
    for order in range(rows.shape[1]):
        for j in range(rows.shape[2]):
            for k in range(rows.shape[3]):
                a, b, c = rows[0, order, j, k], rows[2, order, j, k], rows[4, order, j, k]
                rows[1, order, j, k] = (3 * a + 6 * b - c) / 8
                rows[3, order, j, k] = (3 * c + 6 * b - a) / 8
    for k in _within(events, t, 2 * h):     # but for those who have just come, or gone
        for i in (1, 3):
            _shapes(t + h / 2 * i, k, k + 1, length, contacts, rows[i], work.between, work.knot)


@njit(**COMPILED)
def _shapes(t, first, last, length, contacts, rows, between, knot):  # type: ignore[no-untyped-def]
    """Participations of a range of slots at time t."""
    paths, tables, points = contacts.paths, contacts.shapes.ravel(), contacts.shapes.shape[3]
    for k in range(first, last):
        place = min(max(paths[2, k] * (t - paths[0, k]) / length, 0.0), 1.0) * (points - 1)
        nearest = min(max(int(place), 1), points - 3)
        between[k] = place - nearest
        knot[k] = (nearest - 1) + k * (len(tables) // len(contacts.shapes))
    for order in range(rows.shape[0]):
        for j in range(rows.shape[1]):
            for k in range(first, last):
                i = np.uint64(knot[k] + (order * rows.shape[1] + j) * points)
                on_deck = (t >= paths[0, k]) & (t <= paths[1, k])
                value = _cubic(tables[i], tables[i + ONE], tables[i + TWO], tables[i + THREE], between[k])
                rows[order, j, k] = value if on_deck else 0.0


@njit(**COMPILED)
def _forces(t, contacts, force, between, knot):  # type: ignore[no-untyped-def]
    """Walking forces at time t, of those off the deck too."""
    periods, tables, points = contacts.periods, contacts.combs.ravel(), contacts.combs.shape[1]
    for k in range(len(force)):
        cycle = t * periods[0, k]
        place = (cycle - np.floor(cycle)) * periods[1, k]
        nearest = int(place)
        between[k] = place - nearest
        knot[k] = nearest + k * points
    for k in range(len(force)):
        i = np.uint64(knot[k])
        force[k] = _spline(tables[i], tables[i + ONE], tables[i + TWO], tables[i + THREE], between[k])


_spline = njit(**COMPILED)(spline)


@njit(**COMPILED)
def _cubic(a, b, c, d, s):  # type: ignore[no-untyped-def]
    """The cubic through a, b, c and d at −1, 0, 1 and 2, at s."""
    return s * (s - 1) * ((s + 1) * d - (s - 2) * a) / 6 + (s + 1) * (s - 2) * ((s - 1) * b - s * c) / 2


@njit(**COMPILED)
def _shape(table, place):  # type: ignore[no-untyped-def]
    """A shape at a place in (0, 1) along the deck."""
    knot = place * (len(table) - 1)
    i = min(max(int(knot), 1), len(table) - 3)
    return _cubic(table[i - 1], table[i], table[i + 1], table[i + 2], knot - i)


@njit(**COMPILED)
def _sum(field, i, drive, unsprung, force):  # type: ignore[no-untyped-def]
    """Modal forces and the factored mass matrix of node i, from its participations."""
    rows, root = field.rows[i, 0], field.root[i]
    n_m, n = rows.shape
    for p in range(n_m):
        total = drive[p]
        for k in range(n):
            total += rows[p, k] * force[k]
        field.load[i, p] = total
        for q in range(p + 1):
            total = 1.0 if p == q else 0.0
            for k in range(n):
                total += rows[p, k] * unsprung[k] * rows[q, k]
            for r in range(q):
                total -= root[p, r] * root[q, r]
            root[p, q] = np.sqrt(total) if p == q else total / root[q, q]


@njit(**COMPILED)
def _go(t, h, first, stride, bridge, contacts, events, drive, field, kept, force, x, work, record):  # type: ignore[no-untyped-def]
    """Record the state at t and take a step of h, over nodes first, first + stride and first + 2 stride."""
    weights = bridge.weights[stride - 1]
    late = _within(events, t, h)
    if not len(late):
        _keep(x, record)
        _step(field, first, stride, weights, bridge.modes, contacts.bodies, x, work)
        record[2] = work.acceleration
        return
    _record(field, first, bridge, contacts, x, work, record)
    for i in range(3):
        kept.rows[i] = field.rows[first + i * stride]
    for k in late:
        _smooth(t, h, k, bridge.length, contacts, kept.rows)
    for i in range(3):
        node = first + i * stride
        _sum(kept, i, drive[node], contacts.bodies[3], force[node])
    _step(kept, 0, 1, weights, bridge.modes, contacts.bodies, x, work)


@njit(**COMPILED)
def _smooth(t, h, k, length, contacts, rows):  # type: ignore[no-untyped-def]
    """Nodal values of slot k that keep the moments of its shapes over a step in which it steps on or off."""
    arrival, departure, speed = contacts.paths[0, k], contacts.paths[1, k], contacts.paths[2, k]
    start, half = max(t, arrival), (min(t + h, departure) - max(t, arrival)) / 2
    moments = np.empty(3)
    for order in range(rows.shape[1]):
        for j in range(rows.shape[2]):
            moments[:] = 0.0
            for i in range(len(NODES)):
                at = start + half * (1 + NODES[i])
                part = WEIGHTS[i] * half / h * _shape(contacts.shapes[k, order, j], speed * (at - arrival) / length)
                for power in range(3):
                    moments[power] += part * ((at - t) / h) ** power
            for i in range(3):
                rows[i, order, j, k] = np.dot(FROM_MOMENTS[i], moments)


@njit(**COMPILED)
def _keep(x, record):  # type: ignore[no-untyped-def]
    """Record displacements and velocities of the modes."""
    for j in range(record.shape[1]):
        record[0, j], record[1, j] = x[0, j], x[1, j]


@njit(**COMPILED)
def _record(field, i, bridge, contacts, x, work, record):  # type: ignore[no-untyped-def]
    """Record the state at node i, accelerations with it."""
    _keep(x, record)
    _force(field, i, bridge.modes, contacts.bodies, x, work.n[0], record[2])


@njit(**COMPILED)
def _step(field, first, stride, w, modes, bodies, x, work):  # type: ignore[no-untyped-def]
    """One step, from the state x on. Leaves z̈ at its beginning in `work`.

    Rows of the weights w: 0 to 3 for free motion over half a step, 4 and 5 for the first forcing alone, 6 to 9 for
    the first and the second; 10 to 13 for free motion over the step, 14 to 17 for the first and the third forcing,
    18 to 23 for all, the two in the middle together.
    """
    y, n, unused = work.y, work.n, np.empty(modes.shape[1])
    _force(field, first, modes, bodies, x, n[0], work.acceleration)
    for k in range(y.shape[1]):
        y[0, k] = w[0, k] * x[0, k] + w[1, k] * x[1, k] + w[4, k] * n[0, k]
        y[1, k] = w[2, k] * x[0, k] + w[3, k] * x[1, k] + w[5, k] * n[0, k]
    _force(field, first + stride, modes, bodies, y, n[1], unused)
    for k in range(y.shape[1]):
        y[0, k] = w[0, k] * x[0, k] + w[1, k] * x[1, k] + w[6, k] * n[0, k] + w[8, k] * n[1, k]
        y[1, k] = w[2, k] * x[0, k] + w[3, k] * x[1, k] + w[7, k] * n[0, k] + w[9, k] * n[1, k]
    _force(field, first + stride, modes, bodies, y, n[2], unused)
    for k in range(y.shape[1]):
        y[0, k] = w[10, k] * x[0, k] + w[11, k] * x[1, k] + w[14, k] * n[0, k] + w[16, k] * n[2, k]
        y[1, k] = w[12, k] * x[0, k] + w[13, k] * x[1, k] + w[15, k] * n[0, k] + w[17, k] * n[2, k]
    _force(field, first + 2 * stride, modes, bodies, y, n[3], unused)
    for k in range(y.shape[1]):
        middle = n[1, k] + n[2, k]
        position = (w[10, k] * x[0, k] + w[11, k] * x[1, k]
                    + w[18, k] * n[0, k] + w[20, k] * middle + w[22, k] * n[3, k])
        x[1, k] = (w[12, k] * x[0, k] + w[13, k] * x[1, k]
                   + w[19, k] * n[0, k] + w[21, k] * middle + w[23, k] * n[3, k])
        x[0, k] = position


@njit(**COMPILED)
def _force(field, i, modes, bodies, x, n, acceleration):  # type: ignore[no-untyped-def]
    """Modal accelerations at node i of a field, and the forcing n of modes and bodies that move alone otherwise."""
    rows, n_m = field.rows[i], modes.shape[1]
    stiffness, damping, sprung, unsprung = bodies[0], bodies[1], bodies[2], bodies[3]
    pull, u, du = n[n_m:], x[0, n_m:], x[1, n_m:]
    pull[:] = 0.0
    for j in range(n_m):
        z, dz, row = x[0, j], x[1, j], rows[0, j]
        for k in range(len(pull)):
            pull[k] += row[k] * (stiffness[k] * z + damping[k] * dz)
    if len(rows) > 1:      # convective: the contact moves along the shape
        for j in range(n_m):
            for k in range(len(pull)):
                pull[k] += damping[k] * rows[1, j, k] * x[0, j]
    for j in range(n_m):
        total, row = field.load[i, j] - modes[0, j] * x[0, j] - modes[1, j] * x[1, j], rows[0, j]
        for k in range(len(pull)):
            total += row[k] * sprung[k] * (stiffness[k] * u[k] + damping[k] * du[k] - pull[k])
        if len(rows) > 1:
            for q in range(n_m):
                for k in range(len(pull)):
                    total -= row[k] * unsprung[k] * (2 * rows[1, q, k] * x[1, q] + rows[2, q, k] * x[0, q])
        acceleration[j] = total
    _solve(field.root[i], acceleration)
    for j in range(n_m):
        n[j] = acceleration[j] + modes[0, j] * x[0, j] + modes[1, j] * x[1, j]


@njit(**COMPILED)
def _solve(root, b):  # type: ignore[no-untyped-def]
    """Solve in place with a Cholesky factor."""
    for i in range(len(b)):
        for q in range(i):
            b[i] -= root[i, q] * b[q]
        b[i] /= root[i, i]
    for i in range(len(b) - 1, -1, -1):
        for q in range(i + 1, len(b)):
            b[i] -= root[q, i] * b[q]
        b[i] /= root[i, i]
