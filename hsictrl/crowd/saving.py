"""Traffic in a file, and back: every number as it is, nothing that runs."""

from __future__ import annotations

import json
import secrets
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hsictrl._checks import Array
from hsictrl.crowd.trajectory import Trajectory
from hsictrl.crowd.walkers import ARRAYS, Walkers
from hsictrl.pedestrian import Crowd
from hsictrl.walking import HarmonicForce, MainHarmonics, WalkingForce, YoungForce, ZivanovicForce

MARK, FORMAT = "hsictrl traffic", 1
FORCES: dict[str, Callable[..., WalkingForce]] = {
    kind.__name__: kind for kind in (HarmonicForce, YoungForce, ZivanovicForce, MainHarmonics)}
PLAIN = ("window", "target", "spread", "drawn_from")
Arrays = dict[str, NDArray[Any]]


def save(path: Path, traffic: Mapping[str, Any]) -> None:
    """Write traffic into a file; whatever is there stays as it is until all is written.

    Parameters
    ----------
    path : Path
        The file.
    traffic : mapping
        Fields of `Traffic` by name.
    """
    walkers: Walkers = traffic["walkers"]
    head = {"mark": MARK, "format": FORMAT, "forces": [_described(force) for force in walkers.forces],
            "traffic": {name: traffic[name] for name in PLAIN}}
    arrays: Arrays = {"head": np.array(json.dumps(head)), "model": walkers.model}
    arrays |= {name: getattr(walkers, name) for name in ARRAYS} | _crowd_arrays("bodies", walkers.bodies)
    arrays |= {f"draws_{i}": table for i, table in enumerate(walkers.draws)} | _trajectory_arrays(walkers)
    if traffic["standing"] is not None:
        people, places = traffic["standing"]
        arrays |= {"standing_places": places} | _crowd_arrays("standing", people)
    _write(path, arrays)


def load(path: Path) -> dict[str, Any]:
    """Read what `save` has written.

    Parameters
    ----------
    path : Path
        The file.

    Returns
    -------
    dict
        Fields of `Traffic` by name.
    """
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as found:
            arrays = {name: found[name] for name in found.files}
        head = json.loads(arrays["head"].item())
        mark, form = head["mark"], head["format"]
        if mark != MARK:
            raise ValueError(f"it is marked {mark!r}")
    except OSError as error:
        raise ValueError(f"{path}: the traffic must be a file that can be read, got {error.strerror or error}; correct "
                         "the path") from None
    except (ValueError, KeyError, TypeError, AttributeError, EOFError, RuntimeError, zipfile.BadZipFile) as error:
        raise ValueError(f"{path}: the file must be one that Traffic.save has written, got another: {error}; correct "
                         "the path") from None
    if form != FORMAT:
        raise ValueError(f"{path}: the file must be of format {FORMAT}, got {form}; read it with the version "
                         "of hsictrl that wrote it, or a later one")
    try:
        return _traffic(head, arrays)
    except (KeyError, TypeError, ValueError, IndexError) as error:
        raise ValueError(f"{path}: the file must hold what Traffic.save has written, got damage: {error}; save it "
                         "anew") from None


def _traffic(head: Mapping[str, Any], arrays: Arrays) -> dict[str, Any]:
    forces = tuple(_force(one) for one in head["forces"])
    walkers = Walkers(
        bodies=_crowd("bodies", arrays), forces=forces, model=arrays["model"],
        draws=[arrays[f"draws_{i}"] for i in range(len(forces))], **{name: arrays[name] for name in ARRAYS},
        trajectories=_trajectories(arrays))
    standing = (_crowd("standing", arrays), arrays["standing_places"]) if "standing_places" in arrays else None
    return {"walkers": walkers, "standing": standing} | {name: head["traffic"][name] for name in PLAIN}


def _described(value: Any) -> Any:
    """A force in words and numbers."""
    if not isinstance(value, WalkingForce):
        return value
    kind = type(value).__name__
    if FORCES.get(kind) is not type(value):
        raise ValueError(f"only forces of hsictrl can be saved, got {kind}; draw the traffic anew where it is needed")
    return {"kind": kind} | {one.name: _described(getattr(value, one.name)) for one in fields(value)}


def _force(words: Mapping[str, Any]) -> WalkingForce:
    own = {name: _force(value) if isinstance(value, dict) else value for name, value in words.items() if name != "kind"}
    return FORCES[words["kind"]](**own)


def _crowd_arrays(name: str, people: Crowd) -> Arrays:
    return {f"{name}_{one}": getattr(people, one) for one in Crowd.__slots__}


def _crowd(name: str, arrays: Arrays) -> Crowd:
    return Crowd(**{one: arrays[f"{name}_{one}"] for one in Crowd.__slots__})


def _trajectory_arrays(walkers: Walkers) -> Arrays:
    """All places in a row, and how many belong to each walker: none to those who go straight on."""
    if not walkers.trajectories:
        return {}
    points = [np.empty((0, 3)) if one is None else np.column_stack([one.times, one.x, one.y])
              for one in walkers.trajectories]
    return {"trajectory_points": np.concatenate(points), "trajectory_sizes": np.array([len(one) for one in points])}


def _trajectories(arrays: Arrays) -> list[Trajectory | None]:
    if "trajectory_points" not in arrays:
        return []
    parts: list[Array] = np.split(arrays["trajectory_points"], np.cumsum(arrays["trajectory_sizes"])[:-1])
    return [Trajectory(*part.T) if len(part) else None for part in parts]


def _write(path: Path, arrays: Arrays) -> None:
    """Into a file beside it, which then takes its place."""
    if not path.name:
        raise ValueError(f"{path}: the file must have a name, got none; choose one")
    beside = path.with_name(f".{secrets.token_hex(8)}")    # short: a name may be as long as it can be
    try:
        with beside.open("xb") as file:
            np.savez(file, **arrays)  # type: ignore[arg-type]
        beside.replace(path)
    except OSError as error:
        raise ValueError(f"{path}: the file must be one that can be written, got {error.strerror}; choose "
                         "another") from None
    finally:
        beside.unlink(missing_ok=True)
