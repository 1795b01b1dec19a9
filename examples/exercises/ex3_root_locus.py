"""
Exercise 3: Root locus over crowd size
======================================

The crowd as a feedback gain that grows person by person: where the poles of the bridge go, and where they end.
"""

# %% [markdown]
# **Goal.** You can draw the root locus of a bridge over the size of its crowd by hand, and say from it how many
# people damp best.
#
# Theory
# ------
#
# N equal people are spread over a half sine, so that Σφ² = N/2 (exercise 1). One mode of modal mass m_B and the
# bodies make the characteristic equation
#
# .. math::
#
#     1 + \kappa\, L_1(s) = 0, \qquad \kappa = \frac{N}{2 m_B}, \qquad
#     L_1(s) = \frac{s^2 \alpha(s)}{s^2 + 2\xi\omega s + \omega^2}
#
# with the apparent mass α of one body. This is the form of every root locus: κ is the gain, the open loop has
# the poles of bridge and body, and its zeros are those of s²α. Multiplied out, it is a polynomial of degree
# four:
#
# .. math::
#
#     (s^2 + 2\xi\omega s + \omega^2)(s^2 + 2\xi_1\omega_1 s + \omega_1^2) +
#     \kappa s^2 \left[ m_0 s^2 + (m_0 + m_1)(2\xi_1\omega_1 s + \omega_1^2) \right] = 0
#
# Only one combination of the bodies takes part in it. The other N − 1 pairs of poles stay at 3.25 Hz and 30 %
# (exercise 2).
#
# Tasks
# -----
#
# 1. Find the four roots for N = 15, 75 and 225 on the 2 Hz reference bridge. Check them against ``ct.poles`` of
#    ``hsi.couple``.
# 2. Where do the branches end as κ grows without bound? What do these motions look like?
# 3. Derive in which direction the pole p of the bridge departs as the first person steps on. Check it by a
#    difference.
# 4. Draw the loci for 0 to 225 people on bridges of 2, 3.5 and 4 Hz. On the one of 3.5 Hz: for which N is the
#    least damped pole damped the most? What changes there?
# 5. Get the same loci from ``hsi.root_locus``.
#
# Hints
# -----
#
# * ``np.polymul``, ``np.polyadd`` and ``np.roots`` do it; four coefficients can't go wrong, four hundred would.
# * Branches end in the zeros of the open loop. There the bodies' force is all that counts.
# * Differentiate the characteristic equation with respect to κ at κ = 0.
# * People at the quarter points count by φ² = 1/2, like a crowd that is spread.
#
# Solution
# --------
#
# **Task 1.** Poles that the roots leave out are the bodies' own.

# %%
import control as ct
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi

body = hsi.Pedestrian()
M0, M1 = body.unsprung_mass, body.sprung_mass
BODY = np.array([1.0, 2 * body.damping * body.omega, body.omega**2])
HELD = np.array([M0, *(M0 + M1) * BODY[1:], 0.0, 0.0])    # the bracket, times s²


def roots(frequency, n):
    """The four poles under n people, upper ones first."""
    omega = 2 * np.pi * frequency
    bridge = np.array([1.0, 2 * 0.005 * omega, omega**2])
    found = np.roots(np.polyadd(np.polymul(bridge, BODY), n / 2 / 25e3 * HELD))
    return found[np.argsort(-found.imag)]


def spread(n):
    return (np.arange(n) + 0.5) * 50 / n


for n in (15, 75, 225):
    poles = ct.poles(hsi.couple(hsi.reference_bridge(frequency=2.0), body, spread(n)))
    ours = roots(2.0, n)
    assert np.abs(np.subtract.outer(ours, poles)).min(axis=1).max() < 1e-8
    slow = ours[np.argmax(ours.real)]
    print(f"{n:3} people: bridge at {abs(slow) / 2 / np.pi:.4f} Hz, {-slow.real / abs(slow):.3%}")

# %% [markdown]
# **Task 2.** Two branches end at the origin: a bridge that is nothing but crowd has no spring of its own. The
# other two end where the bracket vanishes. There the two masses of a body swing against each other in free
# space, at ω₁√(1 + m₁/m₀) with a damping of ξ₁√(1 + m₁/m₀). That is 1.34, so these zeros are real.

# %%
free = np.sqrt(1 + M1 / M0)
ends = body.omega * free * (-body.damping * free + np.array([1, -1]) * np.sqrt((body.damping * free)**2 - 1))
far = roots(2.0, 1e9)
assert np.allclose(np.sort(far.real)[:2], np.sort(ends), rtol=1e-3)
assert np.all(np.abs(far[np.argsort(far.real)[2:]]) < 0.1)

# %% [markdown]
# **Task 3.** With p² + 2ξωp + ω² + κp²α(p) = 0, the derivative at κ = 0 is dp/dκ = −p²α(p)/(2p + 2ξω): the
# apparent mass of exercise 1, turned by the direction of p. Mass makes the pole sink, dashpots push it to the
# left.

# %%
for frequency in (2.0, 3.5, 4.0):
    omega = 2 * np.pi * frequency
    p = omega * (-0.005 + 1j * np.sqrt(1 - 0.005**2))
    slope = -p**2 * body.apparent_mass(p) / (2 * p + 2 * 0.005 * omega)
    step = 1e-3
    now = roots(frequency, step)
    moved = now[np.argmin(np.abs(now - p))]
    assert np.isclose((moved - p) / (step / 2 / 25e3), slope, rtol=1e-3)

# %% [markdown]
# **Task 4.** At 2 Hz people are mass. At 3.5 Hz the pole of the bridge runs to the left, towards that of the
# bodies, and turns back: 82 people damp best, and whoever comes then adds mass more than damping. At 4 Hz it
# goes on to the left, and it is the pole of the bodies that becomes the least damped. Somewhere in between the
# modes have shifted (section 3.3).

# %%
sizes = np.arange(226)
loci = {f: np.array([roots(f, n)[:2] for n in sizes]) for f in (2.0, 3.5, 4.0)}
least = np.min(-loci[3.5].real / np.abs(loci[3.5]), axis=1)
best = int(np.argmax(least))
bridge = hsi.reference_bridge(frequency=3.5)
around = [ct.poles(hsi.couple(bridge, body, spread(n))) for n in (best - 1, best, best + 1)]
checked = [np.min(-poles.real / np.abs(poles)) for poles in around]
assert checked[1] == max(checked)
print(f"3.5 Hz: {best} people damp best, {least[best]:.2%}")

# %%
figure, ax = plt.subplots(figsize=(7, 5), layout="constrained")
for i, (frequency, locus) in enumerate(loci.items()):
    ax.plot(locus.real.ravel(), locus.imag.ravel() / (2 * np.pi), ".", color=f"C{i}", markersize=3,
            label=f"{frequency:g} Hz")
    ax.plot(locus[0].real, locus[0].imag / (2 * np.pi), "kx")
ax.plot(loci[3.5][best].real, loci[3.5][best].imag / (2 * np.pi), "o", color="C1", markerfacecolor="none",
        label=f"3.5 Hz, {best} people")
ax.set(xlabel="Real part [1/s]", ylabel="Imaginary part / 2π [Hz]", xlim=(None, 0))
ax.legend(title="× nobody", markerscale=2, frameon=False)
plt.show()

# %% [markdown]
# **Task 5.** The branches of ``hsi.root_locus`` are sorted by continuity, those of the bridge first; the host's
# own ``ct.root_locus_plot`` takes the poles of a crowd through one large polynomial and loses them.

# %%
ready = hsi.root_locus(bridge, body, np.full(225, 12.5)).poles[:, :4]
assert all(np.abs(np.subtract.outer(loci[3.5][n], ready[n])).min(axis=1).max() < 1e-8 for n in range(1, 226))

# %% [markdown]
# **Think on.** Draw the locus over the damping of the bodies instead. Which damping would a body need on the
# 3.5 Hz bridge? ``hsi.root_locus(..., parameter="damping", values=...)`` shows it.
