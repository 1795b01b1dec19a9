"""Truth: the same study in place. The cluster is a real one, of two worker processes."""

import os
import signal
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from dask.distributed import Client, LocalCluster

from hsictrl.study import Ledger, MeanRule, monte_carlo, trial_rng

NEVER = MeanRule(tolerance=1e-9)
N = 150


def lognormal(rng: np.random.Generator) -> float:
    return rng.lognormal(sigma=0.2)


def deadly(folder: Path, lives: int, rng: np.random.Generator) -> float:
    """Trial 60 kills its worker until so many of them have died."""
    value = lognormal(rng)
    deaths = len(list(folder.iterdir()))
    if value == lognormal(trial_rng(1, 60)) and deaths < lives:
        (folder / str(deaths)).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return value


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        yield client


@pytest.fixture(scope="module")
def alone() -> np.ndarray:
    return monte_carlo(lognormal, rule=NEVER, max_trials=N).samples


def test_a_dask_cluster_gives_the_same_digits(client: Client, alone: np.ndarray) -> None:
    assert len(set(client.run(os.getpid).values()) - {os.getpid()}) == 2
    spread_out = monte_carlo(lognormal, rule=NEVER, max_trials=N, executor=client.get_executor())
    assert spread_out.samples.tobytes() == alone.tobytes()


def test_a_killed_dask_worker_changes_no_digit(client: Client, alone: np.ndarray, tmp_path: Path) -> None:
    (deaths := tmp_path / "deaths").mkdir()
    spread_out = monte_carlo(partial(deadly, deaths, 1), rule=NEVER, max_trials=N, executor=client.get_executor(),
                             ledger=Ledger(tmp_path / "study.ledger"))
    assert len(list(deaths.iterdir())) == 1
    assert spread_out.samples.tobytes() == alone.tobytes()
