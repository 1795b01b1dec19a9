"""What all tests share: tried examples of properties are the same everywhere, and no test sees another's figures."""

from collections.abc import Iterator

import matplotlib.pyplot as plt
import pytest
from hypothesis import settings

settings.register_profile("reproducible", deadline=None, derandomize=True)
settings.load_profile("reproducible")


@pytest.fixture(autouse=True)
def no_figures() -> Iterator[None]:
    plt.close("all")
    yield
    plt.close("all")
