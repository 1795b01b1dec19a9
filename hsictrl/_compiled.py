"""How the compiled kernels are compiled, and indices that are read without a check of their sign."""

from __future__ import annotations

from typing import Any

import numpy as np

# No fast mathematics: freely ordered sums are a fifth faster, but round differently in code from a cache.
COMPILED: dict[str, Any] = {"nogil": True, "error_model": "numpy"}
# What allocates nothing need not count references to arrays: half of the time of a step with ten people.
BORROWING: dict[str, Any] = {**COMPILED, "_nrt": False}
ONE, TWO, THREE = np.uint64(1), np.uint64(2), np.uint64(3)      # unsigned, or every index is checked for its sign
