"""Names of signals: F[0], F[1], …, which python-control takes by base name and slice."""

from __future__ import annotations

from collections.abc import Sequence


def labels(bases: str | Sequence[str], n: int) -> list[str]:
    """``base[0]``, ``base[1]``, …; of several bases, all of index 0 first."""
    bases = [bases] if isinstance(bases, str) else bases
    return [f"{base}[{i}]" for i in range(n) for base in bases]
