"""
Exercise 1: The walker as an absorber
=====================================

What one person who stands on a bridge does to its frequency and its damping, by hand.
"""

# %% [markdown]
# **Goal.** You can say from the apparent mass of a body what it does to a lightly damped mode, and at which
# frequency a walker damps best.
#
# Theory
# ------
#
# A person is a mass m₀ on the deck and a mass m₁ on a spring and a damper (section 2.2). The body's equation of
# motion, (A.3), gives the force that moves the contact point with acceleration a. Their ratio is the *apparent
# mass*:
#
# .. math::
#
#     \alpha(s) = m_0 + m_1 \frac{2\xi_1\omega_1 s + \omega_1^2}{s^2 + 2\xi_1\omega_1 s + \omega_1^2}
#
# The deck feels the force −α a. One mode with modal mass m, and a person where its shape is φ (one at the
# antinode), have the dynamic stiffness
#
# .. math::
#
#     D(s) = m (s^2 + 2\xi\omega s + \omega^2) + \phi^2 s^2 \alpha(s)
#
# On the axis s = iω the real part of α acts as mass. A dashpot c would add iωc to D; the imaginary part of α
# adds −ω² i Im α, so it is a dashpot of −ω Im α. On an undamped bridge, to first order in α/m,
#
# .. math::
#
#     \frac{\Delta f}{f} = -\frac{\phi^2}{2m} \mathrm{Re}\,\alpha(i\omega), \qquad
#     \Delta\xi = -\frac{\phi^2}{2m} \mathrm{Im}\,\alpha(i\omega)
#
# Tasks
# -----
#
# 1. Draw Re α and Im α of ``hsi.Pedestrian()`` from 0 to 8 Hz. Give both by hand at 0 Hz, at the body's own
#    frequency, and for very high frequencies, and check them.
# 2. Put one person on the antinode of undamped reference bridges of 1 to 6 Hz. Compare the true damping, that
#    of the pole, ``hsi.effective(..., method="pole")``, with the formula. Show that the error is of second
#    order: it falls by four if the body's mass is halved.
# 3. At which frequency of the bridge does a walker damp best? Set the derivative of Im α to zero by hand.
# 4. N equal people stand at x = (i + ½)L/N on a half sine. How many on the antinode do they replace? Check it
#    on the frequency response.
#
# Hints
# -----
#
# * At ω = ω₁ the fraction is 1 + 1/(2iξ₁).
# * With r = ω/ω₁, −Im α = m₁ 2ξ₁ r³/((1 − r²)² + 4ξ₁² r²). The condition for its maximum is quadratic in r².
# * People count by φ². Sum sin² over the places.
#
# Solution
# --------
#
# **Task 1.** The whole mass at 0 Hz, the unsprung mass far above, and m₀ + m₁ − i m₁/(2ξ₁) in between: 70 −
# 111i kg.

# %%
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi

body = hsi.Pedestrian()
m0, m1, xi1 = body.unsprung_mass, body.sprung_mass, body.damping

expected = {1e-6: 70.0, body.frequency: m0 + m1 - 1j * m1 / (2 * xi1), 1e9: m0}
for frequency, mass in expected.items():
    assert np.isclose(body.apparent_mass(2j * np.pi * frequency), mass, atol=1e-6)

# %% [markdown]
# **Task 2.** The formula reads α where the pole of the empty bridge is, so what it leaves out is of second
# order in the mass.

# %%
def damping(bridge, one):
    return hsi.effective(hsi.couple(bridge, one, [25.0]), method="pole").damping


def first_order(bridge, one):
    return -one.apparent_mass(2j * np.pi * bridge.modes[0].frequency).imag / (2 * bridge.modes[0].modal_mass)


bridges = [hsi.reference_bridge(frequency=f, damping=0.0) for f in np.linspace(1.0, 6.0, 51)]
exact = np.array([damping(bridge, body) for bridge in bridges])
guess = np.array([first_order(bridge, body) for bridge in bridges])
assert np.abs(exact - guess).max() < 0.02 * guess.max()

errors = [damping(bridges[10], one) - first_order(bridges[10], one) for one in (body, hsi.Pedestrian(mass=35.0))]
assert abs(errors[0] / errors[1] - 4) < 0.1

# %% [markdown]
# **Task 3.** The derivative vanishes where r⁴ + (2 − 4ξ₁²) r² = 3: at 3.40 Hz, a little above the body's own
# frequency.

# %%
half = 1 - 2 * xi1**2
best = body.frequency * np.sqrt(np.sqrt(half**2 + 3) - half)
hertz = np.linspace(0.01, 8.0, 8001)
alpha = body.apparent_mass(2j * np.pi * hertz)
assert abs(hertz[np.argmin(alpha.imag)] - best) < 1e-3
print(f"a walker damps best at {best:.3f} Hz: {100 * guess.max():.2f} % on a bridge of 25 t")

# %% [markdown]
# **Task 4.** The squares of the sines add up to N/2: fifteen people spread over the deck are seven and a half
# at the antinode. Equal bodies on one mode merge exactly.

# %%
x = (np.arange(15) + 0.5) * 50 / 15
assert np.isclose(np.sum(np.sin(np.pi * x / 50) ** 2), 7.5)
spread = hsi.couple(bridges[10], body, x)
heap = hsi.couple(bridges[10], hsi.Pedestrian(mass=7.5 * 70.0), [25.0])
assert np.allclose(hsi.frf(spread, hertz).frdata, hsi.frf(heap, hertz).frdata, rtol=1e-10)

# %%
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 6), layout="constrained")
above.plot(hertz, alpha.real, label="Re α, mass")
above.plot(hertz, -alpha.imag, "--", label="−Im α, damping")
above.axvline(best, color="0.6", linewidth=0.8)
above.set(xlabel="Frequency [Hz]", ylabel="Apparent mass [kg]", xlim=(0, 8))
above.legend(frameon=False)
below.plot([bridge.modes[0].frequency for bridge in bridges], 100 * exact, label="pole of the occupied bridge")
below.plot([bridge.modes[0].frequency for bridge in bridges], 100 * guess, "--", label="first order")
below.axvline(best, color="0.6", linewidth=0.8)
below.set(xlabel="Frequency of the empty bridge [Hz]", ylabel="Damping [%]", xlim=(0, 8), ylim=(0, None))
below.legend(frameon=False)
plt.show()

# %% [markdown]
# **Think on.** Below 2 Hz people are little but mass, above 5 Hz they are isolated by their own springs and
# hardly there. Im α is never positive: a standing person takes energy at every frequency, so a standing crowd
# can't make a bridge unstable.
