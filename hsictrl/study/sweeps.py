"""A study over named axes: one Monte Carlo study per cell, and what all cells found in labelled arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from importlib import metadata
from itertools import product
from math import prod
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._progress import progress
from hsictrl.study.batches import Trial, TrialError
from hsictrl.study.ensembles import Ensemble
from hsictrl.study.estimates import Axes, Estimates, Value, place_of
from hsictrl.study.ledger import Ledger
from hsictrl.study.ratios import ratios
from hsictrl.study.rules import PercentileRule, StopRule
from hsictrl.study.trials import PAPER_RULE, check_callable, check_study, settled

if TYPE_CHECKING:
    import xarray as xr


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sweep:
    """What the studies of a sweep have found.

    Parameters
    ----------
    axes : dict
        The values of each axis by its name: those of the cells, then those that the trials of a cell share.
    shared : tuple of str
        The names of the latter.
    name : str
        What the estimate is called.
    units : dict
        Unit by name of an axis, or by `name` for the estimate.
    ensembles : tuple of Ensemble
        The study of each cell, the last axis of the cells changing fastest.
    seed : int
        Seed of every cell [-].

    Examples
    --------
    >>> found = sweep(lambda scale: lambda rng: rng.rayleigh(scale), {"scale": [1, 2]}, name="peak")
    >>> (found.estimate / 2.448).round(1), found.converged
    (array([1., 2.]), array([ True,  True]))
    """

    axes: Axes
    shared: tuple[str, ...]
    name: str
    units: dict[str, str]
    ensembles: tuple[Ensemble, ...]
    seed: int

    @property
    def estimate(self) -> Array:
        """Estimates, one dimension per axis [unit of the trials]."""
        return self._over_axes([one.estimate for one in self.ensembles])

    @property
    def low(self) -> Array:
        """Low ends of their intervals [unit of the trials]."""
        return self._over_axes([one.interval[0] for one in self.ensembles])

    @property
    def high(self) -> Array:
        """High ends of their intervals [unit of the trials]."""
        return self._over_axes([one.interval[1] for one in self.ensembles])

    @property
    def trials(self) -> NDArray[np.int_]:
        """Number of trials of each cell [-]."""
        return np.reshape([one.n_trials for one in self.ensembles], _shape(self._cells))

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Whether every estimate of a cell has settled."""
        return np.reshape([one.converged for one in self.ensembles], _shape(self._cells))

    def at(self, point: Mapping[str, Value]) -> Estimates:
        """Pick one value of each of some axes.

        Parameters
        ----------
        point : mapping
            A value, exactly as it stands on the axis, by the name of its axis.

        Returns
        -------
        Estimates
            Estimates and their intervals over the other axes [unit of the trials].

        Examples
        --------
        >>> found = sweep(lambda scale: lambda rng: rng.rayleigh(scale), {"scale": [1, 2]})
        >>> bool(found.at({"scale": 2}).estimate == found.estimate[1])
        True
        """
        return Estimates(axes=self.axes, estimate=self.estimate, low=self.low, high=self.high).at(point)

    def ratio(self, axis: str, top: Value, bottom: Value) -> Estimates:
        """Ratio of the estimates at two values of a shared axis, with its interval.

        The interval, of the confidence of the rule, is that of a paired percentile bootstrap: both estimates are
        of the same trials, and 2000 resamples of these keep them together.

        Parameters
        ----------
        axis : str
            The axis, one that the trials share.
        top, bottom : float or str
            The two values, exactly as they stand on the axis [unit of the axis].

        Returns
        -------
        Estimates
            Ratios and their intervals over the other axes [-].

        Examples
        --------
        >>> def make(scale):
        ...     return lambda rng: scale * rng.rayleigh() * np.array([1.0, 3.0])
        >>> found = sweep(make, {"scale": [1, 2]}, shared={"storey": ["low", "high"]})
        >>> found.ratio("storey", "high", "low").estimate.round(6)
        array([3., 3.])
        """
        if not self.shared:
            raise ValueError(f"a ratio must run along an axis that the trials share, got {axis!r} and none shared; "
                             "sweep with shared={...}")
        check.choice("axis", axis, self.shared)
        rule = check.instance("rule", self.ensembles[0].rule, PercentileRule, "sweep with PercentileRule(...)")
        places = [place_of(self.axes, axis, value) for value in (top, bottom)]
        found = [ratios(rule, *self._along(axis, one.samples, places)) for one in self.ensembles]
        kept = {name: values for name, values in self.axes.items() if name != axis}
        estimate, low, high = (np.reshape(end, _shape(kept)) for end in zip(*found, strict=True))
        return Estimates(axes=kept, estimate=estimate, low=low, high=high)

    def to_xarray(self) -> xr.Dataset:
        """Return estimates, intervals, trials and whether they settled as labelled arrays.

        Returns
        -------
        xarray.Dataset
            A dimension per axis. The estimates have the name of the sweep, their ends that with ``_low`` and ``_high``
            [unit of the trials].

        Notes
        -----
        xarray is optional: ``pip install 'hsictrl[data]'``. ``to_netcdf`` of the dataset writes it to a file.

        Examples
        --------
        >>> found = sweep(lambda scale: lambda rng: rng.rayleigh(scale), {"scale": [1, 2]}, name="peak")
        >>> list(found.to_xarray().data_vars)
        ['peak', 'peak_low', 'peak_high', 'trials', 'converged']
        """
        xr = _xarray()
        ends = {self.name: self.estimate, f"{self.name}_low": self.low, f"{self.name}_high": self.high}
        told = {"trials": self.trials, "converged": self.converged}
        unit = self._unit(self.name)
        return xr.Dataset(
            {**{name: (list(self.axes), values, unit) for name, values in ends.items()},
             **{name: (list(self._cells), values) for name, values in told.items()}},
            coords={name: (name, list(values), self._unit(name)) for name, values in self.axes.items()},
            attrs={"seed": self.seed, "rule": repr(self.ensembles[0].rule), "hsictrl": metadata.version("hsictrl")})

    @property
    def _cells(self) -> Axes:
        return {name: values for name, values in self.axes.items() if name not in self.shared}

    def _along(self, axis: str, samples: Array, places: Sequence[int]) -> Iterator[Array]:
        """The samples at some places of a shared axis, a row per trial and a column per place on the other ones."""
        spread = samples.reshape(-1, *(len(self.axes[name]) for name in self.shared))
        picked = np.moveaxis(spread, 1 + self.shared.index(axis), 0)
        return (picked[place].reshape(len(samples), -1) for place in places)

    def _over_axes(self, values: list[Any]) -> Array:
        return np.reshape(np.array(values), _shape(self.axes))

    def _unit(self, name: str) -> dict[str, str]:
        return {"units": self.units[name]} if name in self.units else {}


def sweep(
    make: Callable[..., Trial], axes: Mapping[str, ArrayLike], *, shared: Mapping[str, ArrayLike] | None = None,
    name: str = "estimate", units: Mapping[str, str] | None = None, rule: StopRule = PAPER_RULE, seed: int = 1,
    executor: Executor | None = None, max_trials: int = 20_000, label: str = "sweep", ledger: Ledger | None = None,
) -> Sweep:
    """Run one Monte Carlo study for every combination of the values of some axes.

    Every cell has the same seed. Trial i of one cell and trial i of another draw the same random numbers, so that
    what differs between cells differs because the cells do.

    Parameters
    ----------
    make : callable
        Takes one value of each axis by its name and returns the trial of that cell, as for `monte_carlo`.
    axes : mapping
        Names, such as ``density``, and their values: numbers, or strings.
    shared : mapping, optional
        Further axes, along which all trials of a cell have an answer each. A trial returns one row: a number for every
        combination of their values, the last axis changing fastest. Without them it returns one number.
    name : str
        What the estimate is called.
    units : mapping, optional
        Unit by name of an axis, or by `name` for the estimate.
    rule : StopRule
        Says when an estimate has settled; one with a single estimate, `PercentileRule` or `MeanRule`.
    seed : int
        Seed of every cell [-].
    executor : concurrent.futures.Executor, optional
        Runs the trials of a cell; in place without one.
    max_trials : int
        Trials after which a cell that has not settled is left [-].
    label : str
        What the progress bar calls the sweep, drawn only if stderr is a terminal. With the values of a cell after it,
        the name of the cell in the ledger.
    ledger : Ledger, optional
        Keeps the trials of all cells as they finish, and gives those that it holds in place of running them again.

    Returns
    -------
    Sweep
        The ensembles, and estimates and intervals over the axes [unit of the trials].

    Examples
    --------
    >>> found = sweep(lambda scale: lambda rng: rng.rayleigh(scale), {"scale": [1, 2]}, name="peak")
    >>> bool(np.all((found.low < 2.448 * np.array([1, 2])) & (found.high > 2.448 * np.array([1, 2]))))
    True
    """
    cells, within = _axes("axes", axes), {} if shared is None else _axes("shared", shared)
    _check_names([*axes, *(shared or ())], name, units or {})
    check_callable("make", make, "give a function of one value per axis that returns a trial")
    check.instance("label", label, str, "give the sweep a name")
    check_study(rule, seed, executor, max_trials, ledger)
    _check_rule(rule)
    shape = (prod(_shape(within)),) if within else ()
    study = partial(settled, rule=rule, seed=seed, executor=executor, max_trials=max_trials, ledger=ledger, shape=shape)
    return Sweep(
        axes={**cells, **within}, shared=tuple(within), name=name, units=dict(units or {}),
        ensembles=_run(study, _trials(make, cells, label), label), seed=seed)


def _trials(make: Callable[..., Trial], cells: Axes, label: str) -> dict[str, Trial]:
    """The trial of every cell by its label; all before the first runs, so that a bad one is refused at once."""
    found = {}
    for values in product(*cells.values()):
        point = dict(zip(cells, values, strict=True))
        where = ", ".join([label, *(f"{name}={_told(value)}" for name, value in point.items())])
        if where in found:
            raise ValueError(f"values must tell cells apart, got two cells called '{where}'; change a string")
        with _named(where):
            found[where] = make(**point)
        check_callable(f"what make returns for '{where}'", found[where], "give a function of a numpy.random.Generator")
    return found


def _run(study: Callable[..., Ensemble], trials: Mapping[str, Trial], label: str) -> tuple[Ensemble, ...]:
    found = []
    with progress() as bar:
        task = bar.add_task(label, total=len(trials))
        for where, trial in trials.items():
            with _named(where):
                found.append(study(trial, label=where))
            bar.advance(task)
    return tuple(found)


@contextmanager
def _named(where: str) -> Iterator[None]:
    try:
        yield
    except (TrialError, TypeError, ValueError) as error:
        error.add_note(f"in the cell '{where}'")
        raise


def _told(value: Value) -> str:
    return str(value).removesuffix(".0") if isinstance(value, float) else str(value)


def _shape(axes: Axes) -> tuple[int, ...]:
    return tuple(map(len, axes.values()))


def _axes(kind: str, given: Any) -> Axes:
    found = check.entries(kind, given, "axis", "give a dict of names and their values")
    return {name: _values(f"{kind}[{name!r}]", values) for name, values in found.items()}


def _values(name: str, given: Any) -> tuple[Value, ...]:
    """The values of one axis, all numbers or all strings, none twice."""
    listed = given.tolist() if isinstance(given, np.ndarray) else given
    if _are_words(listed):
        values = tuple(map(str, listed))
    else:
        check.numbers(name, given, ndim=1, count=1, remedy="give a list of numbers, or one of strings")
        values = tuple(np.asarray(given).tolist())
    for k, value in enumerate(values):
        if value in values[:k]:
            raise ValueError(f"{name} must hold each value once, got {value!r} twice; leave one out")
    return values


def _are_words(given: Any) -> bool:
    return (isinstance(given, Sequence) and not isinstance(given, str)
            and len(given) > 0 and all(isinstance(one, str) for one in given))


def _check_names(axes: Sequence[Any], name: str, units: Mapping[str, str]) -> None:
    names = [*axes, name, f"{name}_low", f"{name}_high", "trials", "converged"]
    for k, one in enumerate(names):
        if not isinstance(one, str) or not one.isidentifier():
            raise ValueError(f"the name of an axis or estimate must be one of a Python variable, got {one!r}; "
                             "give letters, digits and _")
        if one in names[:k]:
            raise ValueError(f"axes, estimate, its ends, trials and converged must differ in name, got {one!r} twice; "
                             "rename one")
    for one, unit in check.instance("units", units, Mapping, "give a dict of names and units").items():
        check.choice("a name in units", one, [*axes, name])
        check.instance(f"units[{one!r}]", unit, str, "give a string, such as 'm/s²'")


def _check_rule(rule: StopRule) -> None:
    if len(rule.labels) != 1:
        raise ValueError(f"rule must give one estimate per quantity, got {', '.join(rule.labels)}; "
                         "sweep with one of its members")


def _xarray() -> Any:
    try:
        import xarray
    except ImportError:
        raise ImportError("to_xarray must find xarray, got none; pip install 'hsictrl[data]'") from None
    return xarray
