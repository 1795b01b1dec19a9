"""
Exercise 2: Building the pseudo-moving crowd with feedback
==========================================================

From a bridge and bodies as blocks to the PMC model of the paper, with ``control.feedback`` and nothing else.
"""

# %% [markdown]
# **Goal.** You can close a loop of bridge and people by hand, drive it with forces that walk, and say why the
# result is the pseudo-moving crowd model (PMC).
#
# Theory
# ------
#
# The force of a walker on the deck has two parts (eqs. 3 and 4): the force on rigid ground, which drives, and
# what the body makes of the motion of the deck, which feeds back:
#
# .. math::
#
#     p = p_F - m_0 a + c\,(v_1 - v) + k\,(y_1 - y)
#
# with y, v, a of the deck under the feet and y₁, v₁ of the sprung mass.
#
# PMC lets the first part walk and the second stand still (section 2.4, eq. 11): the system is time-invariant,
# its input moves. With one mode of shape φ, a force p at x does what φ(x) p does at the antinode, where φ = 1.
# So all that walks is one input,
#
# .. math::
#
#     P(t) = \sum_k \varphi(x_k(t))\, p_{F,k}(t), \qquad x_k(t) = v (t - t_k)
#
# As blocks, with a port (y, v, a → F) under each body:
#
# ``bridge.ss(at=...)``
#     Forces F[i] to motion y[i], v[i], a[i] at the given points.
#
# ``people.ss()``
#     Motion under each body to its force on the deck, in the same order.
#
# Tasks
# -----
#
# 1. Twelve people cross the 2 Hz reference bridge, one every 5 s, at 1.25 m/s, two steps a second, with a load
#    factor of 0.4. Make a ``hsi.Traffic`` of them. Who stands for the moving crowd is
#    ``traffic.standing_on(bridge)``.
# 2. Close the loop around the bridge with a port under each of these bodies, and one more at the antinode for
#    P. Check the poles: how many sit at exactly 3.25 Hz and 30 %, and why?
# 3. Drive the loop by P with ``ct.forced_response``, and the empty bridge too. Compare with ``hsi.predict``.
# 4. Which acceleration remains of that of the moving forces alone?
#
# Hints
# -----
#
# * ``hsi.Walker(force=hsi.HarmonicForce([0.4]), step_frequency=2.0, speed=1.25, arrival=5.0)`` is the second of
#   them.
# * Bodies add their force to the deck: the sign of the feedback is +1.
# * ``ct.feedback`` wants an input for every output. At the antinode stands nobody: ``ct.append`` a block of
#   zeros.
# * Equal bodies: only one combination of their motions moves the mode.
# * A cosine at 2π f_s t for each walker, while they are on the deck.
#
# Solution
# --------
#
# **Task 1.**

# %%
import control as ct
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi

bridge = hsi.reference_bridge(frequency=2.0)
force = hsi.HarmonicForce([0.4])
walkers = [hsi.Walker(force=force, step_frequency=2.0, speed=1.25, arrival=5.0 * k) for k in range(12)]
traffic = hsi.Traffic(walkers)
people, places = traffic.standing_on(bridge)
print(f"{len(people)} people stand for the crowd, at {places[:, 0]} m")

# %% [markdown]
# **Task 2.** One mode feels the sum of the contact forces only. In all motions of n equal bodies that leave
# this sum at zero the deck rests, and the bodies swing as on rigid ground: n − 1 pairs of poles at their own
# frequency and damping.

# %%
plant = bridge.ss(at=[*places[:, 0], 25.0])
nobody = ct.ss([], [], [], np.zeros((1, 3)))
loop = ct.feedback(plant, ct.append(people.ss(), nobody), sign=+1)
loop.update_names(inputs=plant.input_labels, outputs=plant.output_labels)  # the host forgets them

own = 2 * np.pi * 3.25 * (-0.3 + 1j * np.sqrt(1 - 0.3**2))
assert np.sum(np.abs(ct.poles(loop) - own) < 1e-6) == len(people) - 1
coupled = ct.poles(hsi.couple(bridge, people, places))
assert np.abs(np.subtract.outer(ct.poles(loop), coupled)).min(axis=1).max() < 1e-6

# %% [markdown]
# **Task 3.** The last input of the loop is P, its last output the acceleration at the antinode. ``hsi.predict``
# solves in the frequency domain; between samples ``ct.forced_response`` takes the force as straight, which at
# 125 samples a period makes an error of some 10⁻⁴.

# %%
times = np.linspace(0.0, 55.0 + 40.0, 23_751)
drive = np.zeros_like(times)
for one in walkers:
    x = one.speed * (times - one.arrival)
    on_deck = (x >= 0) & (x <= 50)
    drive += on_deck * np.sin(np.pi * x / 50) * 0.4 * one.weight * np.cos(4 * np.pi * times)

pair = f"a[{len(people)}]", f"F[{len(people)}]"
with_people = ct.forced_response(loop[pair], times, drive).outputs
without = ct.forced_response(plant[pair], times, drive).outputs
for name, ours in (("PMC", with_people), ("MF", without)):
    theirs = hsi.predict(name, bridge, traffic, timepts=times).response.outputs
    assert np.abs(ours - theirs).max() < 1e-3 * np.abs(theirs).max()

# %% [markdown]
# **Task 4.**

# %%
share = np.abs(with_people).max() / np.abs(without).max()
print(f"{np.abs(without).max():.2f} m/s² without interaction, {share:.0%} of it with interaction")
assert share < 1

figure, ax = plt.subplots(figsize=(7, 3.5), layout="constrained")
ax.plot(times, without, linewidth=0.6, label="MF: forces walk, nobody reacts")
ax.plot(times, with_people, linewidth=0.6, label="PMC: forces walk, bodies stand")
ax.set(xlabel="Time [s]", ylabel="Acceleration at midspan [m/s²]", xlim=(0, times[-1]))
ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1), ncols=2)
plt.show()

# %% [markdown]
# **Think on.** The resonance has moved too: these walkers meet the frequency of the empty bridge, not that of
# the occupied one. ``hsi.tune`` sets step frequencies to what each model calls resonance.
