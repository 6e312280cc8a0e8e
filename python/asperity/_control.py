"""The control of a solve: the one load that is given, by the name of its keyword."""

from __future__ import annotations

from collections.abc import Iterable

#: A load as the compiled core takes it.
Load = tuple[str, float]


def one(**given: float | None) -> Load:
    """The one load of those that may be given."""
    loads = [(name, value) for name, value in given.items() if value is not None]
    if len(loads) != 1:
        found = " and ".join(name for name, _ in loads) or "none"
        raise TypeError(f"give one load, {' or '.join(given)}: {found} given")
    name, value = loads[0]
    return (name, float(value))


def many(**given: Iterable[float] | None) -> list[Load]:
    """The sequence of loads of those that may be given, by the plural of their names."""
    sequences = [(name, values) for name, values in given.items() if values is not None]
    if len(sequences) != 1:
        found = " and ".join(name for name, _ in sequences) or "none"
        raise TypeError(f"give one sequence of loads, {' or '.join(given)}: {found} given")
    name, values = sequences[0]
    return [(name.removesuffix("s"), float(value)) for value in values]
