"""What determines the samples of a study, in words: two studies with the same words have the same samples."""

from __future__ import annotations

import hashlib
import json
import platform
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from importlib import metadata
from pathlib import PurePath
from types import BuiltinFunctionType, CodeType, FunctionType, MethodType
from typing import Any

import numpy as np

Words = dict[str, str]      # where in the study → what stands there

_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(...), PurePath, np.generic)
_NUMERICS = ("numpy", "scipy", "numba", "control")
_SPELLED = 16               # numbers of an array that are told one by one
_DEEP = 50
_SHOWN = 4                  # changes that are told


def described(trial: Callable[..., Any], seed: int) -> Words:
    """Say what determines the samples: trial, seed, versions; not the stop rule, which only says how many."""
    call = type(trial).__call__
    own = _parts("trial.__call__", call) if isinstance(call, FunctionType) else ()
    return {**dict(_parts("trial", trial)), **dict(own), "seed": str(seed), **_versions(trial)}


def digest(words: Words) -> str:
    """Return one string that differs if any of the words do."""
    return _hashed(json.dumps(words, sort_keys=True).encode())


def changes(before: Words, now: Words) -> str:
    """Tell what differs between two studies."""
    names = [name for name in (now | before) if before.get(name) != now.get(name)]
    told = [f"{name} {before.get(name, 'nothing')} → {now.get(name, 'nothing')}" for name in names[:_SHOWN]]
    return "; ".join(told) + (f"; and {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")


def _versions(trial: Any) -> Words:
    thing = trial.func if isinstance(trial, partial) else trial
    kind = thing if hasattr(thing, "__module__") else type(thing)
    packages = dict.fromkeys(("hsictrl", kind.__module__.partition(".")[0]))
    found = {name: getattr(sys.modules.get(name), "__version__", None) for name in packages}
    numerics = {name: metadata.version(name) for name in _NUMERICS}
    # bytecode of functions is part of the words, and differs from one Python to the next
    python = ".".join(platform.python_version_tuple()[:2])
    return {**{name: str(one) for name, one in found.items() if one}, **numerics, "Python": python}


def _parts(name: str, thing: Any, depth: int = 0) -> Iterator[tuple[str, str]]:
    """Name and words of a thing and of everything inside it."""
    if depth > _DEEP:
        raise ValueError(f"a trial must not contain itself, got {name}; give a frozen dataclass")
    words, inside = _read(name, thing)
    yield name, words
    for where, part in inside:
        yield from _parts(name + where, part, depth + 1)


def _read(name: str, thing: Any) -> tuple[str, Iterator[tuple[str, Any]]]:
    if isinstance(thing, _PLAIN):
        return _plain(thing), iter(())
    if isinstance(thing, np.ndarray) and thing.dtype != object:
        return _array(thing), iter(())
    if isinstance(thing, type | BuiltinFunctionType | np.ufunc):
        return _named(thing), iter(())
    return _kind(thing), _inside(name, thing)


def _inside(name: str, thing: Any) -> Iterator[tuple[str, Any]]:
    for kinds, read in _READERS:
        if isinstance(thing, kinds):
            return read(thing)
    if is_dataclass(thing):
        # fields that the constructor doesn't take follow from the others, or are memories of former calls
        return ((f".{one.name}", getattr(thing, one.name)) for one in fields(thing) if one.init)
    if hasattr(thing, "__wrapped__"):       # compiled by numba, or behind a cache
        return iter(((".wrapped", thing.__wrapped__),))
    return _state(name, thing)


def _state(name: str, thing: Any) -> Iterator[tuple[str, Any]]:
    try:
        state = thing.__reduce_ex__(4)      # as pickle reads it
    except TypeError:
        raise TypeError(f"a ledger must be able to tell {name} from another, got {thing!r}; "
                        "give a function, or a dataclass of numbers") from None
    parts = (state,) if isinstance(state, str) else state
    return ((f".state[{k}]", tuple(part) if isinstance(part, Iterator) else part) for k, part in enumerate(parts))


def _function(function: FunctionType) -> Iterator[tuple[str, Any]]:
    yield ".code", function.__code__
    yield ".defaults", (function.__defaults__, function.__kwdefaults__)
    yield from ((f".{name}", cell.cell_contents) for name, cell in
                zip(function.__code__.co_freevars, function.__closure__ or (), strict=True))


def _partial(call: partial[Any]) -> Iterator[tuple[str, Any]]:
    return iter(((".func", call.func), (".args", call.args), (".keywords", call.keywords)))


def _method(method: MethodType) -> Iterator[tuple[str, Any]]:
    return iter(((".of", method.__self__), (".function", method.__func__)))


def _code(code: CodeType) -> Iterator[tuple[str, Any]]:
    return iter(((".bytes", _hashed(code.co_code)), (".constants", code.co_consts), (".names", code.co_names)))


def _sequence(values: Any) -> Iterator[tuple[str, Any]]:
    return ((f"[{index}]", value) for index, value in enumerate(values))


def _set(values: Any) -> Iterator[tuple[str, Any]]:
    # the order of a set differs from process to process
    return _sequence(sorted(values, key=lambda value: json.dumps(list(_parts("", value)))))


def _mapping(values: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    keyed = {json.dumps(list(_parts("", key))) if not isinstance(key, str) else key: key for key in values}
    return ((f"[{name!r}]", values[keyed[name]]) for name in sorted(keyed))


_READERS: tuple[tuple[Any, Callable[[Any], Iterator[tuple[str, Any]]]], ...] = (
    (FunctionType, _function), (partial, _partial), (MethodType, _method), (CodeType, _code),
    ((list, tuple), _sequence), ((set, frozenset), _set), (Mapping, _mapping),
)


def _plain(thing: Any) -> str:
    if isinstance(thing, Enum) or type(thing) not in _PLAIN:
        return f"{type(thing).__name__} {thing!r}"
    return repr(thing)


def _array(values: np.ndarray) -> str:
    exact = np.ascontiguousarray(values)
    content = repr(exact.tolist()) if exact.size <= _SPELLED else f"sha256 {_hashed(exact.tobytes())}"
    return f"{exact.dtype.str} {values.shape} {content}"


def _kind(thing: Any) -> str:
    return _named(thing if isinstance(thing, FunctionType) else type(thing))


def _named(thing: Any) -> str:
    return f"{getattr(thing, '__module__', None) or 'builtins'}.{getattr(thing, '__qualname__', thing.__name__)}"


def _hashed(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
