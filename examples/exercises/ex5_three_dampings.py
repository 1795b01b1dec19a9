"""
Exercise 5: Three definitions of damping
========================================

Peak, pole and half-power answer three questions; where people are on the bridge, the answers part.
"""

# %% [markdown]
# **Goal.** You can name the definition behind a damping ratio, and say when two of them can't be compared.
#
# Theory
# ------
#
# Three ways from a system to one number, all of which ``hsi.effective`` offers:
#
# *Peak* (eq. 17, the paper's): the damping of a mode with the modal mass m_B of the *empty* bridge whose
# accelerance has the same peak.
#
# .. math::
#
#     \xi_{\mathrm{eff}} = \frac{1}{2 m_B \max_\omega |H(\omega)|}
#
# *Pole*: the angle of the mode's pole p, that is how fast a free vibration dies away.
#
# .. math::
#
#     \xi = -\mathrm{Re}\,p / |p|
#
# *Half-power*: the band above 1/√2 of the peak, over twice the frequency of the peak.
#
# .. math::
#
#     \xi = \frac{\omega_2 - \omega_1}{2 \omega_{\mathrm{peak}}}
#
# The accelerance of a mode is (15), with β = ω/ω_B and the β² that belongs to an acceleration:
#
# .. math::
#
#     H(\omega) = -\frac{1}{m_B} \frac{\beta^2}{1 - \beta^2 + 2 i \xi_B \beta}
#
# Tasks
# -----
#
# 1. For the empty bridge, find all three in closed form, without assuming that ξ_B is small. Check them with
#    ``hsi.effective`` for ξ_B of 0.5, 5 and 20 %.
# 2. Load the bridge with 2.5 t of sandbags at the antinode: bodies that are all but rigid. What does each
#    definition say?
# 3. Put 75 walkers on bridges of 1 to 6 Hz and draw all three. Where do they part, and why?
# 4. Somebody measures a free decay. Which of the three do they get? Let the occupied bridge ring and try
#    ``hsi.free_decay``.
#
# Hints
# -----
#
# * With u = 1/β² the inverse square of H is (u − 1)² + 4ξ²u, a parabola in u.
# * Mass m_a at an antinode keeps spring and dashpot, and makes the mass m' = m + m_a.
# * ``sprung_ratio=1e-9`` makes a body that is nearly all unsprung.
# * Start the decay from z = 1 and everybody at rest: ``ct.initial_response`` with the first state.
#
# Solution
# --------
#
# **Task 1.** The parabola has its minimum 4ξ²(1 − ξ²) at u = 1 − 2ξ², and twice that at u = 1 − 2ξ² ± 2ξ√(1 −
# ξ²). So the peak says ξ√(1 − ξ²), the pole ξ, and half-power

# %%
import control as ct
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi

METHODS = ("peak", "pole", "halfpower")


def by_hand(xi):
    top, reach = 1 - 2 * xi**2, 2 * xi * np.sqrt(1 - xi**2)
    width = 1 / np.sqrt(top - reach) - 1 / np.sqrt(top + reach)
    return [xi * np.sqrt(1 - xi**2), xi, width * np.sqrt(top) / 2]


for xi in (0.005, 0.05, 0.2):
    bridge = hsi.reference_bridge(frequency=2.0, damping=xi)
    found = [hsi.effective(bridge, method=method).damping for method in METHODS]
    assert np.allclose(found, by_hand(xi), rtol=1e-6)
    print(f"ξ_B {xi:.1%}:", ", ".join(f"{m} {x:.3%}" for m, x in zip(METHODS, found, strict=True)))

# %% [markdown]
# **Task 2.** Nothing takes more energy than before. The pole's damping falls by √(m/m'), as that of any heavier
# mode does. The peak's *rises* by √(m'/m): the heavier bridge answers less, and (17) books that as damping.
# Half-power follows the pole.

# %%
sand = hsi.Pedestrian(mass=2500.0, sprung_ratio=1e-9)
loaded = hsi.couple(hsi.reference_bridge(frequency=2.0), sand, [25.0])
heavier = 27.5 / 25.0
peak, pole, halfpower = (hsi.effective(loaded, method=method).damping for method in METHODS)
assert np.isclose(pole, 0.005 / np.sqrt(heavier), rtol=1e-6)
assert np.isclose(peak, heavier * by_hand(pole)[0], rtol=1e-6)
assert np.isclose(halfpower, by_hand(pole)[2], rtol=1e-6)
print(f"sand: peak {peak:.3%}, pole {pole:.3%}, half-power {halfpower:.3%}")

# %% [markdown]
# **Task 3.** Below 3 Hz people add mass, and the peak lies above the other two, as with sand. Between 3 and 4
# Hz bridge and bodies share two modes: at 3.6 Hz the pole with the larger part in the response changes, and
# half-power reads the width of both. Far above, all agree.

# %%
x = (np.arange(75) + 0.5) * 50 / 75
hertz = np.linspace(1.0, 6.0, 51)
crowds = [hsi.couple(hsi.reference_bridge(frequency=f), hsi.Pedestrian(), x) for f in hertz]
curves = {m: np.array([hsi.effective(one, method=m).damping for one in crowds]) for m in METHODS}
assert np.all(curves["peak"][hertz < 2.5] > curves["pole"][hertz < 2.5])

# %% [markdown]
# **Task 4.** The pole's, once the faster motions of the bodies have died away.

# %%
occupied = crowds[10]
assert hertz[10] == 2.0
times = np.linspace(0, 40, 8001)
rest = np.zeros(occupied.nstates)
rest[occupied.find_state("z[0]")] = 1.0
decay = ct.initial_response(occupied, times, rest)
read = hsi.free_decay(decay.outputs[400:], timepts=times[400:])
true = hsi.effective(occupied, method="pole")
assert np.isclose(read.damping, true.damping, rtol=2e-3)
print(f"free decay {read.damping:.3%}, pole {true.damping:.3%}, peak {curves['peak'][10]:.3%}")

# %%
figure, ax = plt.subplots(figsize=(7, 4), layout="constrained")
for (method, damping), dashes in zip(curves.items(), ("-", "--", ":"), strict=True):
    ax.plot(hertz, 100 * damping, dashes, label=method)
ax.set(xlabel="Frequency of the empty bridge [Hz]", ylabel="Damping of the occupied bridge [%]")
ax.legend(title="75 walkers, 0.5 %", frameon=False)
plt.show()

# %% [markdown]
# **Think on.** The paper compares its effective damping with measured ones (section 3.4). By which definition
# were they measured, and does it matter at Eeklo's mass ratio?
