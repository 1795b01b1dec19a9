"""
Exercise 7: Monte Carlo and when to stop
========================================

How many crowds it takes to know a percentile, and why an estimate that has come to rest is not yet right.
"""

# %% [markdown]
# **Goal.** You can put an interval on a percentile without assuming a distribution, say how many trials it
# takes, and stop a study without fooling yourself.
#
# Theory
# ------
#
# The paper asks that the true 95th percentile lie within ±5 % of the estimate with a confidence of 95 %
# (section 2.3). Let q be the true p-quantile, and sort n independent trials: X₁ ≤ … ≤ Xₙ. How many of them fall
# below q is a binomial number K with chance p, whatever the distribution. So, for any ranks l and u,
#
# .. math::
#
#     P(X_l \le q \le X_u) = P(l \le K < u)
#
# Choose l as large and u as small as either tail of K allows, 2.5 % each. For large n the estimate is normal,
# with the density f of the trials at q:
#
# .. math::
#
#     \mathrm{sd}(\hat q) \approx \frac{1}{f(q)} \sqrt{\frac{p (1 - p)}{n}}
#
# Tasks
# -----
#
# 1. Write a function for the interval of n sorted samples. For which n has it an upper end at all? Compare with
#    ``hsi.PercentileRule().judge(samples)``.
# 2. Rayleigh samples have q = √(−2 ln(1 − p)). In how many of 4000 studies with n = 200 does your interval hold
#    it? What is the exact chance?
# 3. How many Rayleigh trials are needed for ±5 %? Check the answer with ``hsi.monte_carlo``.
# 4. A colleague looks every 50 trials, and stops as soon as the estimate has changed by less than 1 % since the
#    last look. In how many of 400 studies is it within ±5 % of q? Explain the share by the formula for sd(q̂).
# 5. Use ``hsi.monte_carlo`` for the peak acceleration of a bridge that fifteen people cross.
#
# Hints
# -----
#
# * ``scipy.stats.binom.ppf(0.025, n, p)`` is the smallest k with P(K ≤ k) ≥ 2.5 %. Ranks count from one, Python
#   from zero.
# * The largest sample is an upper end if P(K = n) = pⁿ is at most 2.5 %.
# * A Rayleigh density at q is q (1 − p).
# * A trial is a function of a ``numpy.random.Generator`` that returns a number. It draws people,
#   ``hsi.CrowdFlow(persons=15).sample(bridge, rng=rng, force=...)``, tunes them, ``hsi.tune("MF", bridge,
#   traffic)``, and asks ``hsi.predict``.
#
# Solution
# --------
#
# **Task 1.** pⁿ ≤ 0.025 asks for 72 trials at least.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import binom, norm

import hsictrl as hsi

P = 0.95


def ranks(n):
    """Ranks l and u, counted from one."""
    return int(binom.ppf(0.025, n, P)), int(binom.ppf(0.975, n, P)) + 1


def interval(ordered):
    low, high = ranks(len(ordered))
    return ordered[low - 1], ordered[high - 1]


assert np.ceil(np.log(0.025) / np.log(P)) == 72 == hsi.PercentileRule().least_trials
rng = np.random.default_rng(1)
samples = np.sort(rng.rayleigh(size=500))
assert interval(samples) == hsi.PercentileRule().judge(samples).interval

# %% [markdown]
# **Task 2.** The exact chance is that of l ≤ K < u. It is above 95 %, because ranks are whole numbers.

# %%
q = np.sqrt(-2 * np.log(1 - P))
studies = np.sort(rng.rayleigh(size=(4000, 200)), axis=1)
low, high = ranks(200)
held = np.mean((studies[:, low - 1] <= q) & (q <= studies[:, high - 1]))
exact = binom.cdf(high - 1, 200, P) - binom.cdf(low - 1, 200, P)
assert exact >= 0.95
assert abs(held - exact) < 3 * np.sqrt(exact * (1 - exact) / 4000)
print(f"the interval holds q in {held:.1%} of the studies, exactly {exact:.1%}")

# %% [markdown]
# **Task 3.** The interval reaches 1.96 standard deviations to either side: n = p(1 − p) (1.96/(0.05 q f(q)))²,
# some 800. The upper end reaches further than the lower, and the rule waits for both.

# %%
needed = P * (1 - P) * (1.96 / (0.05 * q * q * (1 - P))) ** 2
taken = [hsi.monte_carlo(lambda rng: rng.rayleigh(), seed=seed).n_trials for seed in range(10)]
print(f"{needed:.0f} trials by the formula, {np.mean(taken):.0f} on average by the rule")
assert needed < np.mean(taken) < 2 * needed

# %% [markdown]
# **Task 4.** An estimate is calm because each trial counts for little, not because it is right. With n trials a
# share of 2Φ(1.96 √(n/813)) − 1 is within ±5 %, and the colleague stops after some 230.

# %%
looks = np.arange(50, 2001, 50)
many = rng.rayleigh(size=(400, 2000))
running = np.array([np.quantile(many[:, :n], P, axis=1, method="hazen") for n in looks]).T
calm = np.abs(np.diff(running)) < 0.01 * running[:, 1:]
stop = 1 + np.argmax(calm, axis=1)
right = np.mean(np.abs(running[np.arange(400), stop] / q - 1) <= 0.05)
expected = 2 * norm.cdf(1.96 * np.sqrt(looks[stop].mean() / needed)) - 1
assert abs(right - expected) < 0.1
print(f"calm after {looks[stop].mean():.0f} trials, and right in {right:.0%} of the studies")

# %% [markdown]
# **Task 5.** Trial i of a study draws from a stream of its own, so that the answer depends on the seed alone,
# not on who computes it. We ask for ±20 % to be quick.

# %%
bridge, flow = hsi.reference_bridge(frequency=2.0), hsi.CrowdFlow(persons=15)


def trial(rng):
    traffic = flow.sample(bridge, rng=rng, force=hsi.HarmonicForce([0.4]))
    return hsi.predict("MF", bridge, hsi.tune("MF", bridge, traffic)).peak_acceleration


study = hsi.monte_carlo(trial, rule=hsi.PercentileRule(tolerance=0.2))
assert study.converged
assert np.allclose(study.interval, interval(np.sort(study.samples)))
print(f"a₉₅ = {study.estimate:.2f} m/s² after {study.n_trials} trials: {study.reason}")

# %%
trials = np.arange(100, study.n_trials + 1)
path = np.array([interval(np.sort(study.samples[:n])) for n in trials])
estimates = [np.quantile(study.samples[:n], P, method="hazen") for n in trials]
figure, ax = plt.subplots(figsize=(7, 3.5), layout="constrained")
ax.plot(np.arange(1, study.n_trials + 1), study.samples, ".", color="0.6", markersize=3, label="trials")
ax.fill_between(trials, *path.T, alpha=0.3, label="95 % interval")
ax.plot(trials, estimates, label="95th percentile")
ax.set(xlabel="Trials", ylabel="Peak acceleration [m/s²]", xlim=(0, None), ylim=(0, None))
ax.legend(frameon=False, loc="lower left", bbox_to_anchor=(0, 1), ncols=3)
plt.show()

# %% [markdown]
# **Think on.** Each look at the interval is a chance to stop on a lucky one. ``hsi.monte_carlo`` looks after
# 100 trials and then each time a quarter more; find out what looking after every trial does to the share of
# task 2.
