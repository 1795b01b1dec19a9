"""
Exercise 6: Moving against standing crowds
==========================================

Why a crowd that walks may be replaced by one that stands, and what is lost.
"""

# %% [markdown]
# **Goal.** You can judge when the pseudo-moving crowd model (PMC) stands for the moving one (MC): by two time
# scales, and by a sum of squares.
#
# Theory
# ------
#
# In the moving crowd model (eqs. 5 to 8) the matrices depend on time, because walker k takes part in the mode
# with the shape φ(x_k(t)). Equal bodies change the dynamic stiffness of a mode (exercise 1) by
#
# .. math::
#
#     s^2 \alpha(s)\, \Sigma(t), \qquad \Sigma(t) = \sum_k \varphi^2(x_k(t))
#
# as long as φ changes little while a body forgets. It forgets in 1/(ξ₁ω₁), and φ = sin(πx/L) changes in L/(πv).
#
# How much Σ moves depends on who arrives when. For Poisson arrivals, N people on the deck on average,
# Campbell's theorem gives mean and variance of a sum over the people at an instant:
#
# .. math::
#
#     \mathrm{E}\,\Sigma = \frac{N}{L} \int_0^L \varphi^2\, dx, \qquad
#     \mathrm{Var}\,\Sigma = \frac{N}{L} \int_0^L \varphi^4\, dx
#
# Tasks
# -----
#
# 1. One walker crosses the 3 Hz reference bridge. Draw the damping from instant to instant with
#    ``hsi.effective_along`` (by the pole), and explain its shape.
# 2. Twenty people walk at equal distances of L/20. Find Σ(t). What does ``hsi.effective_along`` give?
# 3. Let the bridge swing freely under this stream, and under twenty people who stand at these distances.
#    Compare the decays for speeds of 0.6 to 5 m/s. With which power of the speed do they part?
# 4. The same crowd with Poisson arrivals: how much does Σ scatter about N/2? Check it with 20 000 crowds of
#    your own.
#
# Hints
# -----
#
# * The moving system is ``hsi.moving_crowd(bridge, hsi.Traffic([hsi.Walker(...), ...]))``. A walker without
#   walking force has ``force=hsi.HarmonicForce([0.0])``.
# * ``hsi.simulate(crowd, times, initial_state=[1.0, 0.0])`` starts with z = 1; ``ct.initial_response`` does so
#   for a standing crowd.
# * The stream must be there all the time: let people arrive long before the start.
# * The mean of sin² is 1/2, that of sin⁴ is 3/8.
#
# Solution
# --------
#
# **Task 1.** At x a body counts as φ² of itself at the antinode, so that what it adds to the damping follows
# sin²(πvt/L). Averaged over the crossing that is half of what it adds at midspan.

# %%
import control as ct
import matplotlib.pyplot as plt
import numpy as np

import hsictrl as hsi

LENGTH, N = 50.0, 20
bridge, body = hsi.reference_bridge(frequency=3.0), hsi.Pedestrian()


def crowd(arrivals, speed):
    force = hsi.HarmonicForce([0.0])
    return hsi.moving_crowd(bridge, hsi.Traffic([
        hsi.Walker(body=body, force=force, step_frequency=2.0, speed=speed, arrival=t)
        for t in arrivals]))


def damping_of(part):
    """Damping with this share of one body at the antinode."""
    heap = hsi.couple(bridge, hsi.Pedestrian(mass=70.0 * part), [25.0])
    return hsi.effective(heap, method="pole").damping


seconds = np.linspace(0.5, 39.5, 79)
alone = hsi.effective_along(crowd([0.0], 1.25), seconds, method="pole")[1]
square = np.sin(np.pi * 1.25 * seconds / LENGTH) ** 2
assert np.allclose(alone, [damping_of(one) for one in square], rtol=1e-9)
assert np.isclose(np.mean(alone) - 0.005, (damping_of(1.0) - 0.005) / 2, rtol=0.03)

# %% [markdown]
# **Task 2.** At equal distances the squares add up to N/2 at every instant: damping stands still while
# everybody walks.

# %%
def regular(speed):
    gap = LENGTH / N / speed
    return crowd(gap * (np.arange(-N, 3 * N) + 0.5), speed)


steady = hsi.effective_along(regular(1.25), seconds, method="pole")[1]
assert np.allclose(steady, damping_of(N / 2), rtol=1e-9)

# %% [markdown]
# **Task 3.** A body forgets in 0.16 s, the shape under it changes in 13 s: their ratio, about one percent, is
# how far the bodies lag behind. The lag of those who walk uphill and downhill on the shape cancels, and what
# remains is its square.

# %%
speeds, times = np.array([0.625, 1.25, 2.5, 5.0]), np.linspace(0.0, 10.0, 2001)
standing = hsi.couple(bridge, body, (np.arange(N) + 0.5) * LENGTH / N)
start = np.zeros(standing.nstates)
start[standing.find_state("z[0]")] = 1.0
still = ct.initial_response(standing, times, start).outputs
apart = [np.abs(hsi.simulate(regular(v), times, initial_state=[1.0, 0.0]).response.outputs - still).max()
         / np.abs(still).max() for v in speeds]
power = np.polyfit(np.log(speeds), np.log(apart), 1)[0]
assert abs(power - 2) < 0.05
print(f"at 1.25 m/s decays part by {apart[1]:.0e} of the peak, with speed to the power of {power:.2f}")

# %% [markdown]
# **Task 4.** N/2 on average, with a standard deviation of √(3N/8): a good quarter of the mean for twenty
# people. This is what PMC loses. It draws one standing crowd and keeps it, while MC wanders through many.

# %%
rng = np.random.default_rng(1)
sizes = rng.poisson(N, 20_000)
sums = [np.sum(np.sin(np.pi * rng.random(n)) ** 2) for n in sizes]
assert np.isclose(np.mean(sums), N / 2, rtol=0.01)
assert np.isclose(np.std(sums), np.sqrt(3 * N / 8), rtol=0.02)

arrivals = np.cumsum(rng.exponential(LENGTH / 1.25 / N, 4 * N)) - 60.0
poisson = hsi.effective_along(crowd(arrivals, 1.25), seconds, method="pole")[1]

# %%
figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), width_ratios=(3, 2), layout="constrained")
left.plot(seconds, 100 * poisson, label="20 people, Poisson arrivals")
left.plot(seconds, 100 * steady, "--", label="20 people at equal distances")
left.plot(seconds, 100 * alone, ":", label="one walker")
left.set(xlabel="Time [s]", ylabel="Damping of that instant [%]", ylim=(0, None))
left.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1))
right.loglog(speeds, apart, "o-", label="found")
right.loglog(speeds, apart[0] * (speeds / speeds[0]) ** 2, "--", label="square of the speed")
right.set(xlabel="Speed [m/s]", ylabel="Difference of decays, of the peak [-]")
right.set_xticks(speeds, [f"{v:g}" for v in speeds])
right.minorticks_off()
right.legend(frameon=False)
plt.show()

# %% [markdown]
# **Think on.** Σ scatters less, relative to its mean, the larger the crowd. For which N is its scatter below 10
# %? And is PMC better or worse for a bridge of 2 Hz?
