"""
Exercise 4: Sensitivity and where the crowd harms
=================================================

A controller that helps at one frequency harms at another; a crowd is no exception, but it is a generous one.
"""

# %% [markdown]
# **Goal.** You can read from the loop gain where people make a bridge move less and where more, and know what
# bounds both.
#
# Theory
# ------
#
# N equal people spread over one mode make the loop gain (exercise 3)
#
# .. math::
#
#     L(s) = \kappa \frac{s^2 \alpha(s)}{s^2 + 2\xi\omega_B s + \omega_B^2}, \qquad \kappa = \frac{N}{2 m_B}
#
# and the accelerance (14) of the occupied bridge is that of the empty one (15) times the *sensitivity*:
#
# .. math::
#
#     H_{HB} = S\, H_B, \qquad S = \frac{1}{1 + L}
#
# People help where \|S\| < 1, that is, where L keeps further than one from the point −1. Within the circle of
# radius one around −1 they harm.
#
# Bridge and people are stable, so that Bode's integral holds. Since \|S\| tends to a constant S∞ = 1/(1 + κm₀)
# at high frequencies,
#
# .. math::
#
#     \int_0^\infty \ln \left| \frac{S(i\omega)}{S_\infty} \right| d\omega =
#     \frac{\pi}{2} \lim_{s \to \infty} s \left( \frac{S(s)}{S_\infty} - 1 \right)
#
# Tasks
# -----
#
# 1. Compute L and S for 15 and 75 people on the 2 Hz reference bridge. Check S by ``hsi.frf`` with people and
#    without, and by ``hsi.sensitivity``.
# 2. Draw the Nyquist curve of L with the circle around −1, and \|S\|. In which bands do people harm?
# 3. Derive where harm turns into help, on an undamped bridge.
# 4. Evaluate the right side of Bode's integral by hand, and the left side by a sum. What would it be for a
#    controller whose L falls as 1/s²? What is special about people?
# 5. At 1.86 Hz 75 people amplify by almost five. Why is the bridge better off with them?
#
# Hints
# -----
#
# * ``hsi.Pedestrian().apparent_mass(s)`` is α, for an array of s as well.
# * \|1 + L\|² = 1 is an equation with real D₀ = ω_B² − ω² if ξ = 0.
# * For large s, α = m₀ + c/s + … with the damper c = 2ξ₁ω₁m₁ of the body.
# * The sum must reach far: the integrand falls as 1/ω².
#
# Solution
# --------
#
# **Task 1.**

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import brentq

import hsictrl as hsi

body, bridge = hsi.Pedestrian(), hsi.reference_bridge(frequency=2.0)
OMEGA, XI, MODAL_MASS = 4 * np.pi, 0.005, 25e3


def loop_gain(hertz, n, xi=XI):
    s = 2j * np.pi * np.asarray(hertz)
    return n / 2 / MODAL_MASS * s**2 * body.apparent_mass(s) / (s**2 + 2 * xi * OMEGA * s + OMEGA**2)


hertz = np.linspace(0.5, 14.0, 13_501)
for n in (15, 75):
    occupied = hsi.couple(bridge, body, (np.arange(n) + 0.5) * 50 / n)
    ours = 1 / (1 + loop_gain(hertz, n))
    ratio = hsi.frf(occupied, hertz).frdata / hsi.frf(bridge, hertz).frdata
    assert np.allclose(ours, ratio[0, 0], rtol=1e-10)
    assert np.allclose(ours, hsi.sensitivity(occupied)(2j * np.pi * hertz), rtol=1e-10)

# %% [markdown]
# **Task 2.** Just below the frequency of the bridge: people are mass, and the resonance has moved there. And,
# by less than two percent, from 4.3 to 11 Hz, where bodies swing against the deck and take mass off it.

# %%
def edges(n):
    size = np.abs(1 + loop_gain(hertz, n)) - 1
    changes = np.flatnonzero(np.diff(np.sign(size)))
    return [brentq(lambda f: abs(1 + loop_gain(f, n)) - 1, *hertz[i:i + 2]) for i in changes]


for n in (15, 75):
    size = 1 / np.abs(1 + loop_gain(hertz, n))
    first, second, third = edges(n)
    print(f"{n} people harm below {first:.3f} Hz, at most by {size.max():.1f} at {hertz[np.argmax(size)]:.2f} Hz, "
          f"and by {size[hertz > second].max():.3f} from {second:.2f} to {third:.1f} Hz")

# %% [markdown]
# **Task 3.** \|D₀ + κs²α\| = \|D₀\| with real D₀ gives ω² = ω_B²/(1 + κ\|α\|²/(2 Re α)). For light people this
# is the middle between the old and the new resonance.

# %%
def undamped(f):
    return abs(1 + loop_gain(f, 75, xi=0.0)) - 1


edge = brentq(undamped, 1.9, 1.95)
alpha = body.apparent_mass(2j * np.pi * edge)
assert np.isclose(edge, 2.0 / np.sqrt(1 + 75 / 2 / MODAL_MASS * abs(alpha)**2 / (2 * alpha.real)), rtol=1e-9)

# %% [markdown]
# **Task 4.** L tends to κm₀ + κ(c − 2ξω_B m₀)/s, so the right side is −(π/2) κ(c − 2ξω_B m₀)/(1 + κm₀). With an
# L that falls as 1/s² it would be zero: as much harm as help, the waterbed of control. People push back in step
# with velocity, by the dampers of their bodies; on balance they help, and the more so the more of them there
# are.

# %%
c, m0 = body.damping_coefficient, body.unsprung_mass
omega = np.concatenate([np.linspace(1e-3, 200, 400_001), np.geomspace(200.1, 1e6, 40_001)])
for n in (15, 75):
    kappa = n / 2 / MODAL_MASS
    by_hand = -np.pi / 2 * kappa * (c - 2 * XI * OMEGA * m0) / (1 + kappa * m0)
    by_sum = np.trapezoid(np.log((1 + kappa * m0) / np.abs(1 + loop_gain(omega / 2 / np.pi, n))), omega)
    assert np.isclose(by_sum, by_hand, rtol=1e-4)
    print(f"{n} people: Bode's integral {by_sum:.4f} rad/s, by hand {by_hand:.4f} rad/s")

# %% [markdown]
# **Task 5.** Sensitivity compares frequency by frequency, and the empty bridge hardly moves at 1.86 Hz. The
# peaks compare resonance with resonance. Who steps at 1.86 Hz meets more motion with 75 people than without;
# who is free to step at the worst frequency meets a third.

# %%
with_people, empty = (hsi.effective(one).peak for one in (occupied, bridge))
assert with_people < empty / 3
print(f"peaks: {1000 * with_people:.2f} with and {1000 * empty:.2f} mm/s² per N without 75 people")

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4.2), layout="constrained")
for n, dashes in ((15, "--"), (75, "-")):
    gain = loop_gain(hertz, n)
    left.semilogy(hertz, 1 / np.abs(1 + gain), dashes, label=f"{n} people")
    right.plot(gain.real, gain.imag, dashes)
left.axhline(1, color="0.5", linewidth=0.8)
left.set(xlabel="Frequency [Hz]", ylabel="Sensitivity |S| [-]", xlim=(0.5, 6))
left.legend(frameon=False)
right.add_patch(plt.Circle((-1, 0), 1, color="0.85"))
right.plot(-1, 0, "k+")
right.annotate("people harm", (-1, -0.5), (-3.5, -1.5), arrowprops={"arrowstyle": "-", "color": "0.5"})
right.set(xlabel="Re L [-]", ylabel="Im L [-]", aspect="equal", xlim=(-4, 4), ylim=(-2, 6))
plt.show()

# %% [markdown]
# **Think on.** The unsprung mass of a person is small, but without it L would fall as 1/s. Is anything of the
# above different for ``sprung_ratio=1``?
