"""The average of all crowds that a flow may put on the deck, as bodies in places."""

from __future__ import annotations

from typing import Any

import numpy as np

from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd.flow import CrowdFlow
from hsictrl.pedestrian import Crowd

ALONG, ACROSS = (np.polynomial.legendre.leggauss(n) for n in (12, 2))
FREQUENCY, DAMPING, MASS = (np.polynomial.hermite_e.hermegauss(n) for n in (5, 3, 5))
Nodes = tuple[Array, Array]


def mean_crowd(bridge: Footbridge, flow: CrowdFlow) -> tuple[Crowd, Array]:
    """A crowd whose apparent mass is the mean over those that `CrowdFlow.crowd` draws, by quadrature.

    Apparent mass is linear in the mass of a body, so that the nodes of a quadrature over frequency, damping and place
    are a crowd themselves: its bodies have the weights as masses.

    Parameters
    ----------
    bridge : Footbridge
        The bridge, for its deck.
    flow : CrowdFlow
        Says how many people there are and who.

    Returns
    -------
    Crowd
        The nodes; the masses add up to that of n_H people.
    array, shape (n, 2)
        Their places [m].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> people, places = mean_crowd(reference_bridge(), CrowdFlow(density=0.2))
    >>> float(people.mass.sum().round(6)), places.shape
    (2100.0, (360, 2))
    """
    population = flow.population
    (frequency, damping, x, y), shares = _product(
        _normal(population.frequency, FREQUENCY), _normal(population.damping, DAMPING, high=1.0),
        _uniform(0.0, bridge.length, ALONG), across(bridge))
    mass = flow.persons_on(bridge) * np.dot(*_normal(population.mass, MASS))
    n = len(shares)
    people = Crowd(mass=mass * shares, frequency=frequency, damping=damping,
                   sprung_ratio=np.full(n, population.sprung_ratio), direction=np.full(n, population.direction))
    return people, np.column_stack([x, y])


def across(bridge: Footbridge) -> Nodes:
    """Places across the deck [m] and their shares [-]: shapes that are linear in y are integrated exactly."""
    return _uniform(-bridge.width / 2, bridge.width / 2, ACROSS)


def _uniform(low: float, high: float, rule: Nodes) -> Nodes:
    """Nodes and weights of a uniform variable from those on [−1, 1]."""
    nodes, weights = rule
    return low + (high - low) * (1 + nodes) / 2, weights / 2


def _normal(normal: Any, rule: Nodes, high: float = np.inf) -> Nodes:
    """Nodes and weights of a normal; those beyond (0, high), to which it is truncated, are left out."""
    mean, spread = normal
    if not spread:
        return np.array([mean]), np.ones(1)
    values, weights = mean + spread * rule[0], rule[1]
    inside = (values > 0) & (values < high)
    return values[inside], weights[inside] / np.sum(weights[inside])


def _product(*rules: Nodes) -> tuple[list[Array], Array]:
    """Nodes of all variables together, and their weights."""
    grids = np.meshgrid(*(nodes for nodes, _ in rules), indexing="ij")
    weights = np.ones(1)
    for _, one in rules:
        weights = np.multiply.outer(weights, one).ravel()
    return [grid.ravel() for grid in grids], weights
