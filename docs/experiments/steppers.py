"""Error against cost of time integrators for people who walk over a bridge.

``python docs/experiments/steppers.py`` prints the tables, and writes ``steppers.json`` beside this file and
``docs/images/steppers.png``. The page ``docs/stepper.md`` says what follows from them.

The bridge has one mode z, mass-normalised; u are the displacements of the bodies:

    M z̈ + Γ ż + Ω² z = Σ φ (m₁ q + F),   ü = −q,   q = K u + C u̇ − g,   g = φ (K z + C ż),   M = 1 + Σ m₀ φ².

A method is a function that prepares what does not depend on the state, for all steps at once, and returns a step.
In the code w = ż, v = u̇, s = z̈; ``heavy`` is m₁ φ and ``load`` is Σ φ F.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from time import thread_time
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.polynomial.legendre import legder, leggauss, legvander
from scipy.integrate import solve_ivp

from hsictrl.plots._canvas import COLOURS, INK, grid, head

Array = np.ndarray[Any, Any]
State = tuple[Any, ...]                      # z, ż, u, u̇, and what a method carries besides
Step = Callable[..., State]

HERE = Path(__file__).parent
LENGTH, MODAL_MASS, SPRUNG, UNSPRUNG = 50.0, 25e3, 66.5, 3.5
WINDOW, READ = 20.0, 0.04                    # length of the window, and how often it is read [s]
STEPS = (0.04, 0.02, 0.01, 0.005, 0.0025)    # [s]
BAR = 1e-4                                   # error that a default step may make, relative to the peak


# The problems ---------------------------------------------------------------------------------------------------------

@dataclass(frozen=True)
class Problem:
    """People who walk over a bridge of one mode, whose shape is a sine."""

    name: str
    frequency: float
    damping: float
    pace: float
    speed: float
    half_waves: float
    arrival: Array
    phases: Array
    K: Array
    C: Array

    @classmethod
    def drawn(cls, name: str, n: int, frequency: float, damping: float, pace: float, speed: float = 1.3,
              half_waves: float = 1.0) -> Problem:
        """People who arrive, one after another, from the time of a crossing before the window until its end."""
        rng = np.random.default_rng(2017)
        omega, share = 2 * np.pi * rng.normal(3.25, 0.32, n), rng.normal(0.30, 0.05, n)
        arrival, phases = rng.uniform(-LENGTH / speed, WINDOW, n), rng.uniform(0, 2 * np.pi, (2, n))
        return cls(name, frequency, damping, pace, speed, half_waves, arrival, phases, omega**2, 2 * share * omega)

    @property
    def gamma(self) -> float:
        """Damping Γ of the empty bridge [1/s]."""
        return 4 * np.pi * self.damping * self.frequency

    @property
    def square(self) -> float:
        """Stiffness Ω² of the empty bridge [1/s²]."""
        return (2 * np.pi * self.frequency) ** 2

    @property
    def edges(self) -> Array:
        """When everybody steps on, and off; shape (2, n)."""
        return np.array([self.arrival, self.arrival + LENGTH / self.speed])

    def beam(self, t: Any, who: Any = slice(None), order: int = 0) -> Array:
        """Shape under people, or its rate in time, as if the beam had no ends [1/√kg]."""
        rate = self.half_waves * np.pi * self.speed / LENGTH
        return rate**order * np.sin(rate * (t - self.arrival[who]) + order * np.pi / 2) / np.sqrt(MODAL_MASS)

    def shape(self, t: Any, order: int = 0) -> Array:
        """Shape under everybody, or its rate in time, zero off the deck."""
        on, off = self.edges
        return np.where((t >= on) & (t <= off), self.beam(t, order=order), 0.0)

    def force(self, t: Any, order: int = 0) -> Array:
        """Two harmonics of everybody's walking force, or their rate in time [N]."""
        rate = 2 * np.pi * self.pace
        first, second = (np.cos(i * rate * t + self.phases[i - 1] + order * np.pi / 2) for i in (1, 2))
        return rate**order * (283.5 * first + 2**order * 56.0 * second)


def problems() -> list[Problem]:
    """One walker, thirty at three frequencies, a dense crowd, and a deck with a free end; all in resonance."""
    return [
        Problem.drawn("1 at 2 Hz, 0.5 %", 1, 2.0, 0.005, 2.0),
        Problem.drawn("30 at 2 Hz, 0.5 %", 30, 2.0, 0.005, 2.0),
        Problem.drawn("30 at 3.25 Hz, 0.5 %", 30, 3.25, 0.005, 1.625),
        Problem.drawn("30 at 5 Hz, 0.2 %", 30, 5.0, 0.002, 2.5),
        Problem.drawn("150 at 2 Hz, 0.5 %", 150, 2.0, 0.005, 2.0, speed=1.06),
        Problem.drawn("30 at 2 Hz, free end", 30, 2.0, 0.005, 2.0, half_waves=0.5),
    ]


def acceleration(p: Problem, t: float, phi: Array, state: State) -> float:
    """Modal acceleration, by the equations as they are written."""
    z, w, u, v = state[:4]
    modal = phi @ (SPRUNG * (p.K * (u - phi * z) + p.C * (v - phi * w)) + p.force(t))
    return (modal - p.gamma * w - p.square * z) / (1 + UNSPRUNG * phi @ phi)


def reference(p: Problem) -> Array:
    """Modal acceleration by scipy, which stops and starts anew wherever somebody steps on or off."""
    times, n = READ * np.arange(round(WINDOW / READ) + 1), len(p.K)
    stops = np.unique([0.0, *p.edges[(p.edges > 0) & (p.edges < WINDOW)], times[-1]])
    x, found = np.zeros(2 + 2 * n), np.empty(len(times))
    for a, b in pairwise(stops):
        on, inside = p.shape((a + b) / 2) != 0, np.flatnonzero((times >= a) & (times <= b))
        run = solve_ivp(equations(p, on), (a, b), x, "DOP853", np.union1d(times[inside], b), rtol=1e-11, atol=1e-13)
        for i, y in zip(inside, run.y.T, strict=False):
            found[i] = acceleration(p, times[i], p.shape(times[i]), (y[0], y[1], y[2:2 + n], y[2 + n:]))
        x = run.y[:, -1]
    return found


def equations(p: Problem, on: Array) -> Callable[[float, Array], Array]:
    """Rates of the state while nobody steps on or off."""
    def rates(t: float, x: Array) -> Array:
        (z, w), (u, v), phi = x[:2], np.split(x[2:], 2), on * p.beam(t)
        pull = p.K * (phi * z - u) + p.C * (phi * w - v)
        return np.concatenate([[w, acceleration(p, t, phi, (z, w, u, v))], v, pull])

    return rates


# What the methods share -----------------------------------------------------------------------------------------------

class Samples(NamedTuple):
    """Shape and forces at the nodes of every step; walkers are the last axis, where there are any."""

    phi: Array         # (steps, nodes, n)
    load: Array        # Σ φ F, (steps, nodes)
    mass: Array        # 1 + Σ m₀ φ², (steps, nodes)


def sampled(p: Problem, h: float, nodes: Sequence[float], moments: bool) -> Samples:
    """Sample shape and forces at the nodes of every step."""
    phi = shapes(p, h, nodes, min(len(nodes), 3) if moments else 0)
    return Samples(alike(p, phi), (phi * p.force(times(h, nodes))).sum(-1), 1 + UNSPRUNG * (phi**2).sum(-1))


def times(h: float, nodes: Sequence[float]) -> Array:
    """Instants of the nodes of every step, shape (steps, nodes, 1)."""
    return h * (np.arange(round(WINDOW / h))[:, None, None] + np.asarray(nodes)[:, None])


def shapes(p: Problem, h: float, nodes: Sequence[float], moments: int, order: int = 0) -> Array:
    """φ or its rate at the nodes; where somebody steps on or off, those of the polynomial with φ's first moments."""
    phi = p.shape(times(h, nodes), order)
    if moments:
        step, who, legendre = polynomials(p, h, moments)
        values = legvander(2 * np.asarray(nodes) - 1, moments - 1 - order) @ legder(np.eye(moments), order)
        phi[step, :, who] = (2 / h) ** order * legendre @ values.T
    return phi


def polynomials(p: Problem, h: float, moments: int) -> tuple[Array, Array, Array]:
    """Steps in which somebody steps on or off, who, and the Legendre coefficients of φ over the step."""
    inside = np.floor(p.edges / h).astype(int)
    leaves, who = np.nonzero((inside >= 0) & (inside < round(WINDOW / h)))
    step, edge, (x, weights) = inside[leaves, who], p.edges[leaves, who], leggauss(6)
    start, stop = np.where(leaves, step * h, edge), np.where(leaves, edge, (step + 1) * h)
    t = np.linspace(start, stop, 3)[1][:, None] + (stop - start)[:, None] / 2 * x
    basis = legvander(2 * (t / h - step[:, None]) - 1, moments - 1) * (2 * np.arange(moments) + 1)
    share = p.beam(t, who[:, None]) * weights * ((stop - start) / 2 / h)[:, None]
    return step, who, (share[..., None] * basis).sum(1)


def free(square: Any, gamma: Any, h: Any) -> tuple[Any, Any, Any, Any]:
    """Matrix that takes displacement and velocity of a damped oscillator over a step, row by row."""
    omega, decay = np.sqrt(square - gamma**2 / 4), np.exp(-gamma * h / 2)
    c, s = decay * np.cos(omega * h), decay * np.sin(omega * h) / omega
    return c + gamma / 2 * s, s, -square * s, c - gamma / 2 * s


# The methods ----------------------------------------------------------------------------------------------------------

def newmark(p: Problem, h: float, moments: bool) -> Step:
    """Average acceleration (β = 1/4, γ = 1/2) on the arrowhead: the bodies are eliminated."""
    K, C, (phi, load, mass) = p.K, p.C, (a[:, 0] for a in sampled(p, h, [1.0], moments=False))
    inverse, heavy = 1 / (1 + C * h / 2 + K * h**2 / 4), SPRUNG * phi
    whole = mass + p.gamma * h / 2 + p.square * h**2 / 4 + (heavy * phi) @ (1 - inverse)

    def step(i: int, z: float, w: float, u: Array, v: Array, s: float | None = None, b: Any = 0.0) -> State:
        s = acceleration(p, 0.0, p.shape(0.0), (z, w, u, v)) if s is None else s
        z, w, u, v = z + h * w + h**2 / 4 * s, w + h / 2 * s, u + h * v + h**2 / 4 * b, v + h / 2 * b
        b = inverse * (phi[i] * (K * z + C * w) - K * u - C * v)
        s = (load[i] - heavy[i] @ b - p.gamma * w - p.square * z) / whole[i]
        b = b + (1 - inverse) * phi[i] * s
        return z + h**2 / 4 * s, w + h / 2 * s, u + h**2 / 4 * b, v + h / 2 * b, s, b

    return step


def splitting(p: Problem, h: float, moments: bool, parts: Sequence[float] = (1.0,)) -> Step:
    """Bodies for half a part, bridge for a part, bodies for half a part; each moves exactly while the other rests."""
    K, C, ratio, lengths = p.K, p.C, p.C / p.K, h * np.asarray(parts)
    phi, load, mass = sampled(p, h, np.cumsum(parts) - np.asarray(parts) / 2, moments)
    heavy, square = SPRUNG * phi, p.square + (SPRUNG * phi**2) @ K
    bridge = free(square / mass, (p.gamma + (SPRUNG * phi**2) @ C) / mass, lengths)
    bridge, bodies = np.stack(bridge, -1), [free(K, C, length / 2) for length in lengths]

    def step(i: int, z: float, w: float, u: Array, v: Array) -> State:
        for j, (ka, kb, kc, kd) in enumerate(bodies):
            y = phi[i, j] * (z + ratio * w)
            u, v = y + ka * (u - y) + kb * v, kc * (u - y) + kd * v
            y, (a, b, c, d) = (load[i, j] + heavy[i, j] @ (K * u + C * v)) / square[i, j], bridge[i, j]
            z, w = y + a * (z - y) + b * w, c * (z - y) + d * w
            y = phi[i, j] * (z + ratio * w)
            u, v = y + ka * (u - y) + kb * v, kc * (u - y) + kd * v
        return z, w, u, v

    return step


def suzuki(p: Problem, h: float, moments: bool) -> Step:
    """The composition of five such splittings that has order four."""
    part = 1 / (4 - 4 ** (1 / 3))
    return splitting(p, h, moments, (part, part, 1 - 4 * part, part, part))


def gauss(p: Problem, h: float, moments: bool) -> Step:
    """Collocation at the two Gauss points, on the arrowhead: a 2 × 2 matrix of its own eliminates every body."""
    K, C, r, one = p.K, p.C, np.sqrt(3) / 6, np.eye(2)
    c, a = np.array([0.5 - r, 0.5 + r]), np.array([[0.25, 0.25 - r], [0.25 + r, 0.25]])
    phi, load, mass = sampled(p, h, c, moments)
    pull = h**2 * (a @ a)[..., None] * K + h * a[..., None] * C                           # (2, 2, n)
    inverse = np.linalg.inv(one + pull.transpose(2, 0, 1)).transpose(1, 2, 0)
    pairs = SPRUNG * phi[:, :, None, None] * phi[:, None, :, None]                        # (steps, 2, 2, 1, n)
    crowd = (pairs @ (inverse[:, :, None] * pull).transpose(0, 1, 3, 2))[..., 0, :].sum(2)
    whole = np.linalg.inv(mass[:, :, None] * one + p.gamma * h * a + p.square * h**2 * a @ a + crowd)
    heavy, last, ahead = SPRUNG * phi, h**2 * (1 - c) / 2, h * c

    def step(i: int, z: float, w: float, u: Array, v: Array) -> State:
        there = z + ahead * w
        b = phi[i] * (K * there[:, None] + C * w) - K * (u + ahead[:, None] * v) - C * v
        b = inverse[:, 0] * b[0] + inverse[:, 1] * b[1]
        s = whole[i] @ (load[i] - p.gamma * w - p.square * there - (heavy[i] * b).sum(-1))
        g = phi[i] * (pull[:, 0] * s[0] + pull[:, 1] * s[1])
        b = b + inverse[:, 0] * g[0] + inverse[:, 1] * g[1]
        return (z + h * w + last @ s, w + h / 2 * s.sum(),
                u + h * v + last[0] * b[0] + last[1] * b[1], v + h / 2 * (b[0] + b[1]))

    return step


def hermite(p: Problem, h: float, moments: bool, sweeps: int = 2) -> Step:
    """Modes and bodies exact under forcings that are cubic over the step; their ends found by repetition."""
    forcings, anew = ends(p, h, moments)
    (A, B), (a, b) = cubic_weights(p.square, p.gamma, h), cubic_weights(p.K, p.C, h)
    (ma, mb, mc, md), (ka, kb, kc, kd) = free(p.square, p.gamma, h), free(p.K, p.C, h)

    def step(i: int, z: float, w: float, u: Array, v: Array, *carried: Any) -> State:
        f, df, g, dg = forcings(i, 0, z, w, u, v) if anew[i] else carried
        z, w = ma * z + mb * w + A[0] * f + A[1] * df, mc * z + md * w + B[0] * f + B[1] * df
        u, v = ka * u + kb * v + a[0] * g + a[1] * dg, kc * u + kd * v + b[0] * g + b[1] * dg
        f, g = f + h * df, g + h * dg
        for _ in range(sweeps):
            f, df, g, dg = forcings(i, 1, z + A[2] * f + A[3] * df, w + B[2] * f + B[3] * df,
                                    u + a[2] * g + a[3] * dg, v + b[2] * g + b[3] * dg)
        return (z + A[2] * f + A[3] * df, w + B[2] * f + B[3] * df,
                u + a[2] * g + a[3] * dg, v + b[2] * g + b[3] * dg, f, df, g, dg)

    return step


def cubic_weights(square: Any, gamma: Any, h: float) -> tuple[Array, Array]:
    """What a forcing and its rate, at the start and at the end, add to an oscillator's displacement and velocity."""
    x, weights = leggauss(12)
    t = (1 + x) / 2
    cubics = np.array([2 * t**3 - 3 * t**2 + 1, h * (t**3 - 2 * t**2 + t), 3 * t**2 - 2 * t**3, h * (t**3 - t**2)])
    _, b, _, d = free(np.asarray(square)[..., None], np.asarray(gamma)[..., None], h * (1 - t))
    return (h / 2 * weights * cubics) @ b.T, (h / 2 * weights * cubics) @ d.T


def ends(p: Problem, h: float, moments: bool) -> tuple[Callable[..., State], Array]:
    """Forcings z̈ + Γ ż + Ω² z and g with their rates at both ends, and whether those of the last step are no use."""
    K, C, gamma, square, t, count = p.K, p.C, p.gamma, p.square, times(h, (0.0, 1.0)), 3 if moments else 0
    phi, rate = (shapes(p, h, (0.0, 1.0), count, order) for order in (0, 1))
    load, drift = (phi * p.force(t)).sum(-1), (rate * p.force(t) + phi * p.force(t, 1)).sum(-1)
    mass, growth = 1 + UNSPRUNG * (phi**2).sum(-1), 2 * UNSPRUNG * (phi * rate).sum(-1)
    phi, rate, events = alike(p, phi), alike(p, rate), polynomials(p, h, 1)[0]
    heavy, rising = SPRUNG * phi, SPRUNG * rate

    def forcings(i: int, j: int, z: float, w: float, u: Array, v: Array) -> State:
        y, at = K * z + C * w, (i, j)
        g = phi[at] * y
        q = K * u + C * v - g
        s = (load[at] + heavy[at] @ q - gamma * w - square * z) / mass[at]
        dg = rate[at] * y + phi[at] * (K * w + C * s)
        modal = drift[at] + rising[at] @ q + heavy[at] @ (K * v - C * q - dg)
        jerk = (modal - (growth[at] + gamma) * s - square * w) / mass[at]
        return s + gamma * w + square * z, jerk + gamma * s + square * w, g, dg

    return forcings, np.isin(np.arange(len(t)), [0, *events, *(events + 1)])


def coupling(p: Problem, h: float, moments: bool) -> Callable[..., tuple[Any, Array, Array]]:
    """z̈, and g and q of all bodies, at start, middle and end of a step."""
    K, C, (phi, load, mass) = p.K, p.C, sampled(p, h, (0.0, 0.5, 1.0), moments)
    heavy = SPRUNG * phi

    def at(i: int, j: int, z: float, w: float, u: Array, v: Array) -> tuple[Any, Array, Array]:
        g = phi[i, j] * (K * z + C * w)
        q = K * u + C * v - g
        return (load[i, j] + heavy[i, j] @ q - p.gamma * w - p.square * z) / mass[i, j], g, q

    return at


def runge_kutta(p: Problem, h: float, moments: bool) -> Step:
    """The classical method of order four."""
    at = coupling(p, h, moments)

    def step(i: int, z: float, w: float, u: Array, v: Array) -> State:
        total = start = now = (z, w, u, v)
        for j, weight, ahead in ((0, h / 6, h / 2), (1, h / 3, h / 2), (1, h / 3, h), (2, h / 6, 0.0)):
            s, _, q = at(i, j, *now)
            slope = now[1], s, now[3], -q
            total = tuple(a + weight * b for a, b in zip(total, slope, strict=True))
            now = tuple(a + ahead * b for a, b in zip(start, slope, strict=True)) if ahead else total
        return total

    return step


def lawson(p: Problem, h: float, moments: bool) -> Step:
    """The same for what is left of the equations when modes and bodies move exactly on their own."""
    at = coupling(p, h, moments)
    (a, b, c, d), (A, B, C, D) = (free(p.square, p.gamma, x) for x in (h / 2, h))
    (ka, kb, kc, kd), (KA, KB, KC, KD) = (free(p.K, p.C, x) for x in (h / 2, h))

    def forcings(i: int, j: int, z: float, w: float, u: Array, v: Array) -> tuple[Any, Array]:
        s, g, _ = at(i, j, z, w, u, v)
        return s + p.gamma * w + p.square * z, g

    def step(i: int, z: float, w: float, u: Array, v: Array) -> State:
        f1, g1 = forcings(i, 0, z, w, u, v)
        zh, wh, uh, vh = a * z + b * w, c * z + d * w, ka * u + kb * v, kc * u + kd * v
        z, w, u, v = A * z + B * w, C * z + D * w, KA * u + KB * v, KC * u + KD * v
        f, g = h / 2 * f1, h / 2 * g1
        f2, g2 = forcings(i, 1, zh + b * f, wh + d * f, uh + kb * g, vh + kd * g)
        f3, g3 = forcings(i, 1, zh, wh + h / 2 * f2, uh, vh + h / 2 * g2)
        f, g = h * f3, h * g3
        f4, g4 = forcings(i, 2, z + b * f, w + d * f, u + kb * g, v + kd * g)
        f, g = 2 * (f2 + f3), 2 * (g2 + g3)
        return (z + h / 6 * (B * f1 + b * f), w + h / 6 * (D * f1 + d * f + f4),
                u + h / 6 * (KB * g1 + kb * g), v + h / 6 * (KD * g1 + kd * g + g4))

    return step


def krogstad(p: Problem, h: float, moments: bool) -> Step:
    """Modes and bodies exact under forcings that are polynomials through those of four stages (Krogstad 2005)."""
    at, (half, whole) = coupling(p, h, moments), (under_powers(p.square, p.gamma, x) for x in (h / 2, h))
    body_half, body_whole = (under_powers(p.K, p.C, x) for x in (h / 2, h))

    def forcings(i: int, j: int, z: float, w: float, u: Array, v: Array) -> tuple[Any, Array]:
        s, g, _ = at(i, j, z, w, u, v)
        return s + p.gamma * w + p.square * z, g

    def step(i: int, z: float, w: float, u: Array, v: Array) -> State:
        f1, g1 = forcings(i, 0, z, w, u, v)
        f2, g2 = forcings(i, 1, *half(z, w, f1), *body_half(u, v, g1))
        f3, g3 = forcings(i, 1, *half(z, w, f1, 2 * (f2 - f1)), *body_half(u, v, g1, 2 * (g2 - g1)))
        f4, g4 = forcings(i, 2, *whole(z, w, f1, 2 * (f3 - f1)), *body_whole(u, v, g1, 2 * (g3 - g1)))
        f, g = 2 * (f2 + f3), 2 * (g2 + g3)
        return (*whole(z, w, f1, f - 3 * f1 - f4, 2 * (f1 + f4) - f),
                *body_whole(u, v, g1, g - 3 * g1 - g4, 2 * (g1 + g4) - g))

    return step


def under_powers(square: Any, gamma: Any, h: float) -> Callable[..., tuple[Any, Any]]:
    """How oscillators move over h under forcings n₀ + n₁ τ + n₂ τ², τ = t/h; velocities follow by parts."""
    x, weights = leggauss(6)
    tau = (1 + x) / 2
    a, b, c, d = free(square, gamma, h)
    late = free(np.asarray(square)[..., None], np.asarray(gamma)[..., None], h * (1 - tau))[1]
    p0, p1, p2 = h / 2 * (weights * tau ** np.arange(3)[:, None]) @ late.T

    def moved(z: Any, w: Any, n0: Any, n1: Any = None, n2: Any = None) -> tuple[Any, Any]:
        z, w = a * z + b * w + p0 * n0, c * z + d * w + b * n0
        if n1 is not None:
            z, w = z + p1 * n1, w + p0 / h * n1
        if n2 is not None:
            z, w = z + p2 * n2, w + 2 / h * p1 * n2
        return z, w

    return moved


# Errors and costs -----------------------------------------------------------------------------------------------------

class Method(NamedTuple):
    """A method, how often a step passes over the walkers, and how the figure marks it."""

    name: str
    prepare: Callable[..., Step]
    passes: int
    marker: str
    order: int = 4


METHODS = (
    Method("Newmark", newmark, 1, "s", order=2),
    Method("Strang", splitting, 1, "D", order=2),
    Method("Suzuki", suzuki, 5, "v"),
    Method("RK4", runge_kutta, 4, "^"),
    Method("Gauss", gauss, 1, "o"),
    Method("Hermite", hermite, 2, "P"),
    Method("Lawson", lawson, 4, "X"),
    Method("Krogstad", krogstad, 4, "*"),
)


def record(method: Method, p: Problem, h: float, moments: bool) -> Array:
    """Modal acceleration where the window is read."""
    step, every, found = method.prepare(p, h, moments), round(READ / h), []
    state: State = (0.0, 0.0, alike(p, np.zeros(len(p.K))), alike(p, np.zeros(len(p.K))))
    for i in range(round(WINDOW / h) + 1):
        if i % every == 0:
            found.append(acceleration(p, i * h, p.shape(i * h), state))
        if i * h < WINDOW - h / 2:
            state = step(i, *state)
    return np.array(found)


def measured(method: Method, p: Problem, exact: Array, h: float, moments: bool) -> tuple[float, float]:
    """Error relative to the peak, and the best of three times it took, on this thread [s per s]."""
    spent = []
    for _ in range(3 if moments else 1):
        start = thread_time()
        found = record(method, p, h, moments)
        spent.append(thread_time() - start)
    return np.abs(found - exact).max() / np.abs(exact).max(), min(spent) / WINDOW


def row(method: Method, p: Problem, exact: Array, moments: bool) -> dict[str, Any]:
    """Errors and costs of a method on a problem at all steps, and the order they show."""
    errors, costs = zip(*(measured(method, p, exact, h, moments) for h in STEPS), strict=True)
    usable = [i for i, error in enumerate(errors) if 1e-9 < error < 0.2]
    order = np.polyfit(np.log(np.take(STEPS, usable)), np.log(np.take(errors, usable)), 1)[0]
    step, cost = (at_bar(errors, values) for values in (STEPS, costs))
    return {"problem": p.name, "method": method.name, "moments": moments, "order": round(order, 2), "step at bar": step,
            "cost at bar": cost, "errors": [three(e) for e in errors], "costs": [three(c) for c in costs]}


def three(value: float) -> float:
    """The value to three digits."""
    return float(f"{value:.3g}")


def at_bar(errors: Sequence[float], values: Sequence[float]) -> float | None:
    """The value at which the error crosses the bar, if it does so within the steps tried."""
    if not errors[-1] < BAR < errors[0]:
        return None
    return three(np.exp(np.interp(np.log(BAR), np.log(errors)[::-1], np.log(values)[::-1])))


class Counted(np.ndarray):
    """An array that counts the arithmetic done with it."""

    total = 0

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        """Do as the plain array does, and count."""
        plain = [np.asarray(x) if isinstance(x, Counted) else x for x in inputs]
        result = getattr(ufunc, method)(*plain, **kwargs)
        if ufunc is np.matmul:
            Counted.total += 2 * np.size(plain[0]) * (np.shape(plain[1])[-1] if np.ndim(plain[1]) > 1 else 1)
        else:
            Counted.total += max(map(np.size, (*plain, result)))
        return result.view(Counted) if isinstance(result, np.ndarray) else result


def alike(p: Problem, values: Array) -> Array:
    """The values, as an array that counts if those of the problem do."""
    return values.view(type(p.K))


def operations(method: Method, p: Problem, h: float = 0.04) -> int:
    """Arithmetic of a step for each walker; sampling of shape and force, and reading, are left out."""
    steps, state = round(WINDOW / h), (0.0, 0.0, *np.zeros((2, len(p.K))).view(Counted))
    Counted.total = 0
    step = method.prepare(replace(p, K=p.K.view(Counted), C=p.C.view(Counted)), h, True)
    for i in range(steps):
        state = step(i, *state)
    return round(Counted.total / steps / len(p.K))


# Tables and figure ----------------------------------------------------------------------------------------------------

def show(rows: list[dict[str, Any]], counts: dict[str, int]) -> None:
    """Print one table per problem: errors at all steps, order, and step and cost at the bar."""
    for name in dict.fromkeys(r["problem"] for r in rows):
        print(f"\n{name:24s}" + "".join(f"{1e3 * h:>7g} ms" for h in STEPS) + "   order   at the bar [ms, ms/s]")
        for r in (r for r in rows if r["problem"] == name):
            label = r["method"] + ("" if r["moments"] else ", no moments")
            errors = "".join(f"{e:10.1e}" for e in r["errors"])
            bar = "".join(f"{1e3 * x:10.1f}" if x else f"{'—':>10s}" for x in (r["step at bar"], r["cost at bar"]))
            print(f"{label:24s}{errors}{r['order']:8.2f}{bar}")
    print("\noperations per walker and step:", counts)


def draw(rows: list[dict[str, Any]], to: Path) -> None:
    """Error against cost, a panel for each of four problems; moments are used."""
    names = [p.name for p in problems()]
    chosen = [names[1], names[3], names[4], names[5]]
    figure, axes = plt.subplots(2, 2, figsize=(8.6, 7.2), sharex=True, sharey=True, layout="constrained")
    for ax, name in zip(axes.flat, chosen, strict=True):
        panel(ax, [r for r in rows if r["problem"] == name and r["moments"]])
    head(axes.flat, chosen)
    figure.supxlabel("cost [ms of NumPy per s simulated]", fontsize="medium")
    figure.supylabel("largest error of the acceleration, relative to its peak", fontsize="medium")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False)
    figure.savefig(to, dpi=110)


def panel(ax: Axes, rows: list[dict[str, Any]]) -> None:
    """One line per method, one marker per step; the one at 0.01 s is filled."""
    for r, method, colour in zip(rows, METHODS, (*COLOURS, "0.55"), strict=True):
        x, middle = 1e3 * np.array(r["costs"]), STEPS.index(0.01)
        look = {"color": colour, "marker": method.marker, "linestyle": "--" if method.order == 2 else "-"}
        ax.loglog(x, r["errors"], markerfacecolor="white", label=method.name, **look)
        ax.loglog(x[middle], r["errors"][middle], **look)
    ax.axhline(BAR, color=INK, linewidth=1.2, linestyle=":")
    grid(ax)
    ax.margins(x=0.03)


def main() -> None:
    """Measure, print, write."""
    rows = []
    for p in problems():
        exact = reference(p)
        rows += [row(m, p, exact, moments) for m in METHODS for moments in ((True, False) if m.order == 4 else (True,))]
    counts = {m.name: operations(m, problems()[4]) for m in METHODS}
    show(rows, counts)
    found = {"steps": STEPS, "passes": {m.name: m.passes for m in METHODS}, "operations": counts}
    lines = ",\n    ".join(json.dumps(r) for r in rows)
    (HERE / "steppers.json").write_text(json.dumps(found)[:-1] + f',\n  "rows": [\n    {lines}]}}\n')
    draw(rows, HERE.parent / "images" / "steppers.png")


if __name__ == "__main__":
    main()
