"""The second road of the tests: dense matrices of Appendix A, written out from the paper, and plain evaluations."""

import control as ct
import numpy as np
from scipy.optimize import brentq, linear_sum_assignment


def sines(bridge, x):
    """Mass-normalised shapes sin(jπx/L)/√m_j of a simply supported beam, a row for each place (section 3.1)."""
    j = np.arange(1, bridge.n_modes + 1)
    masses = np.array([mode.modal_mass for mode in bridge.modes])
    return np.sin(np.pi * j * np.atleast_1d(x)[:, None] / bridge.length) / np.sqrt(masses)


def appendix_a(bridge, bodies, rows, drive, sense):
    """A_c, B_c, C_c, D_c of eqs. (A.5)-(A.10) and (8), every matrix dense and inverted as printed."""
    n_m, n = bridge.n_modes, len(bodies)
    omega_b = np.array([2 * np.pi * mode.frequency for mode in bridge.modes])
    xi_b = np.array([mode.damping for mode in bridge.modes])
    m1 = np.array([body.sprung_ratio * body.mass for body in bodies])
    m0 = np.array([body.mass for body in bodies]) - m1
    omega = np.array([2 * np.pi * body.frequency for body in bodies])
    xi = np.array([body.damping for body in bodies])
    M_H0, M_H, K_H, C_H = np.diag(m0), np.diag(m1), np.diag(m1 * omega**2), np.diag(2 * xi * m1 * omega)
    SPhi = np.asarray(rows, dtype=float).reshape(n, n_m)                       # S_pᵀ Φ
    M_B = np.eye(n_m) + SPhi.T @ M_H0 @ SPhi                                   # (A.5)
    C_B = np.diag(2 * xi_b * omega_b) + SPhi.T @ C_H @ SPhi
    K_B = np.diag(omega_b**2) + SPhi.T @ K_H @ SPhi
    M_HB = np.block([[M_B, np.zeros((n_m, n))], [np.zeros((n, n_m)), M_H]])    # (A.9)
    C_HB = np.block([[C_B, -SPhi.T @ C_H], [-C_H @ SPhi, C_H]])                # (A.10)
    K_HB = np.block([[K_B, -SPhi.T @ K_H], [-K_H @ SPhi, K_H]])
    T_p = np.vstack([np.linalg.inv(M_B) @ drive.T, np.zeros((n, len(drive)))])
    half = n_m + n
    lower = -np.linalg.inv(M_HB) @ np.hstack([K_HB, C_HB])
    A = np.vstack([np.hstack([np.zeros((half, half)), np.eye(half)]), lower])  # (A.8)
    B = np.vstack([np.zeros((half, len(drive))), T_p])
    select = np.hstack([sense, np.zeros((len(sense), n))])                     # S_o Φ, zero on the bodies
    return A, B, select @ lower, select @ T_p                                  # (8)


def dense(bridge, bodies, x, force_at=None, sense_at=None):
    """The occupied simply supported beam as a plain `ct.ss`."""
    middle = bridge.length / 2
    drive, sense = (sines(bridge, middle if at is None else at) for at in (force_at, sense_at))
    return ct.ss(*appendix_a(bridge, list(bodies), sines(bridge, np.asarray(x, dtype=float)), drive, sense))


def on_coordinate(bridge, bodies, x, mode=0):
    """The same, from a force on one mode's own coordinate to its acceleration there, at a shape of one."""
    own = np.eye(bridge.n_modes)[mode:mode + 1] / np.sqrt(bridge.modes[mode].modal_mass)
    return ct.ss(*appendix_a(bridge, list(bodies), sines(bridge, np.asarray(x, dtype=float)), own, own))


def transfer(system, s):
    """H(s) = D + C(sI − A)⁻¹B and dH/ds of a SISO system, by plain solves."""
    matrix = s * np.eye(system.nstates) - system.A
    x = np.linalg.solve(matrix, system.B)
    return (system.D + system.C @ x)[0, 0], -(system.C @ np.linalg.solve(matrix, x))[0, 0]


def expanded(system):
    """H and dH/ds of a SISO system as a function of the frequency [Hz], by its poles and residues: D + Σ r/(s − p)."""
    poles, vectors = np.linalg.eig(system.A)
    residues = (system.C @ vectors)[0] * np.linalg.solve(vectors, system.B)[:, 0]

    def evaluate(hertz):
        parts = 1 / (2j * np.pi * np.asarray(hertz)[..., None] - poles)
        return system.D[0, 0] + parts @ residues, -(parts**2 @ residues)

    return evaluate


def peaks(system, low=0.1, high=40.0, points=40_000):
    """(frequency [Hz], |H|) of all local maxima, highest first: a fine grid, then the zero of d|H|²/dω."""
    at, hertz = expanded(system), np.geomspace(low, high, points)
    size = np.abs(at(hertz)[0])
    tops = 1 + np.flatnonzero((size[1:-1] > size[:-2]) & (size[1:-1] >= size[2:]))
    found = []
    for top in tops:
        f = brentq(lambda f: slope(*at(f)), hertz[top - 1], hertz[top + 1], xtol=1e-14, rtol=1e-14)
        found.append((f, abs(transfer(system, 2j * np.pi * f)[0])))
    return sorted(found, key=lambda peak: -peak[1])


def slope(value, growth):
    """Half of d|H|²/dω from H and dH/ds."""
    return (1j * growth * np.conj(value)).real


def distance(poles, others):
    """Largest distance between two sets of poles, each matched to its nearest."""
    apart = np.abs(np.subtract.outer(np.asarray(poles), np.asarray(others)))
    assert apart.shape[0] == apart.shape[1]
    return apart[linear_sum_assignment(apart)].max(initial=0.0)
