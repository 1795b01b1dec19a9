"""Every public name is documented with its units, shows an example, and refuses what it does not know."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from numpydoc.docscrape import FunctionDoc, NumpyDocString

import hsictrl as hsi

NUMERIC = re.compile(r"\b(float|int|complex|array|array_like|number)\b")
NO_QUANTITY = re.compile(r"\b(str|mask)\b")
UNIT_LAST = re.compile(r"\[[^\]]+\]\.$")
PASSED_ON = {"interconnect"}    # has the host's signature; the host refuses what it does not know


def public() -> Iterator[tuple[str, Any]]:
    """Functions and classes at the top level, and the public methods of the classes that are ours."""
    for name in hsi.__all__:
        thing = getattr(hsi, name)
        yield name, thing
        if inspect.isclass(thing):
            own = {key: value for key, value in vars(thing).items() if not key.startswith("_")}
            yield from ((f"{name}.{key}", getattr(thing, key)) for key, value in own.items()
                        if inspect.isfunction(value) or isinstance(value, classmethod))


PUBLIC = dict(public())
CALLABLE = {name: thing for name, thing in PUBLIC.items() if not inspect.isabstract(thing)}


def documentation(thing: Any) -> NumpyDocString:
    return FunctionDoc(thing) if not inspect.isclass(thing) else NumpyDocString(inspect.getdoc(thing) or "")


def described(thing: Any) -> dict[str, Any]:
    """Descriptions by parameter; one entry may describe several."""
    entries = documentation(thing)["Parameters"]
    return {name.strip("* "): entry for entry in entries for name in entry.name.split(",")}


def parameters(thing: Any) -> list[str]:
    return [name for name in inspect.signature(thing).parameters if name not in ("self", "cls", "args", "kwargs")]


@pytest.mark.parametrize("name", PUBLIC)
def test_is_documented_with_an_example(name: str) -> None:
    text = inspect.getdoc(PUBLIC[name])
    assert text, f"{name} has no docstring"
    assert ">>>" in text, f"{name} shows no example"


@pytest.mark.parametrize("name", PUBLIC)
def test_every_parameter_is_described(name: str) -> None:
    missing = set(parameters(PUBLIC[name])) - set(described(PUBLIC[name]))
    assert not missing, f"{name} does not describe {missing}"


@pytest.mark.parametrize("name", PUBLIC)
def test_the_description_of_every_number_ends_with_its_unit(name: str) -> None:
    bare = [key for key, entry in described(PUBLIC[name]).items()
            if NUMERIC.search(entry.type) and not NO_QUANTITY.search(entry.type)
            and not UNIT_LAST.search(" ".join(entry.desc))]
    assert not bare, f"{name} ends without a unit on {bare}"


@pytest.mark.parametrize("name", [name for name in CALLABLE if name not in PASSED_ON])
def test_unknown_keywords_are_refused(name: str) -> None:
    call: Callable[..., Any] = CALLABLE[name]
    kinds = {parameter.kind for parameter in inspect.signature(call).parameters.values()}
    assert inspect.Parameter.VAR_KEYWORD not in kinds
    with pytest.raises(TypeError):
        call(nonsense=1)


def test_interconnect_leaves_unknown_keywords_to_the_host() -> None:
    plant, walker = hsi.reference_bridge().ss(at=[25.0]), hsi.Pedestrian().ss()
    with pytest.raises(TypeError, match="nonsense"):
        hsi.interconnect([plant, walker], inplist=["bridge.F"], outlist=["bridge.a"], nonsense=1)
