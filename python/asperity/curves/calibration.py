"""Probabilities of what a fit of a true model would show by chance.

A model is ruled out by another that fits better. By how much the best of the others fits better than a true model, by
noise alone, follows from the differences of their predictions: over a difference d, which is orthogonal to what the
parameters of the model change, the squares fall by 2⟨d, ε⟩ − |d|² for noise ε, as much at the best place along a path
of such differences. This distribution is sampled. Where no other model fits better, the residuals of neighbouring
points decide.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from .tips import Array, scipy

#: The number of samples, and falls of the squares, in variances, of rounding, and such that none is expected.
_SAMPLES, _NONE, FAR = 1000, 0.02, 60.0
#: As many differences as there are in most curves.
_MOST = 128
#: The square of the length over which a path is straight, in variances: behind it the next place is another fit.
_STRAIGHT = 30.0


@lru_cache(maxsize=4)
def _normal(count: int) -> Array:
    """Samples of normal numbers, so many for differences, and one more for the variance."""
    found = np.random.default_rng(1).normal(size=(count + 1, _SAMPLES))
    found -= found.mean(axis=1)[:, None]
    return np.asarray(found / found.std(axis=1)[:, None])


def falls(paths: list[Array], freedom: int) -> Array:
    """Samples of the fall of the squares, in estimated variances, along paths of differences in deviations of the noise.

    Each path is an array (places, points), between which differences change linearly.
    """
    differences = np.concatenate(paths)
    gram = differences @ differences.T
    # neighbours on a path are nearly alike
    alike = 1e-9 * np.trace(gram) / len(gram) + 1e-300
    normal = _normal(max(len(gram), _MOST))
    across = np.linalg.cholesky(gram + alike * np.eye(len(gram))) @ normal[: len(gram)]
    best = np.zeros(_SAMPLES)
    ends = np.cumsum([len(path) for path in paths])
    squares = np.diag(gram)
    for end, path in zip(ends, paths):
        begin = end - len(path)
        part = 2.0 * across[begin:end] - squares[begin:end, None]
        best = np.maximum(best, part.max(axis=0))
        if len(path) < 2:
            continue
        # the best place between each two
        here, there = slice(begin, end - 1), slice(begin + 1, end)
        mixed = np.diag(gram[here, there])
        lengths = squares[here] + squares[there] - 2.0 * mixed
        rise = across[there] - across[here] - (mixed - squares[here])[:, None]
        share = np.clip(rise / np.maximum(lengths, 1e-300)[:, None], 0.0, (lengths < _STRAIGHT)[:, None])
        inner = part[:-1] + share * (2.0 * rise - share * lengths[:, None])
        best = np.maximum(best, inner.max(axis=0))
    # the variance is estimated: by the cube of a normal number, after Wilson and Hilferty
    variance = (1.0 - 2.0 / (9.0 * freedom) + normal[-1] * np.sqrt(2.0 / (9.0 * freedom))) ** 3
    return np.asarray(best / np.maximum(variance, 0.01))


def probability(fall: float, paths: list[Array], freedom: int, otherwise: Callable[[], float]) -> float:
    """The probability of a fall as large as this one; without a fall, `otherwise`, the probability of what else is seen."""
    special = scipy("special")
    if fall > FAR:
        return float(special.fdtrc(2, freedom, 0.5 * fall))
    samples = falls(paths, freedom) if paths else np.zeros(_SAMPLES)
    if fall <= _NONE:
        some = float(np.mean(samples > _NONE))
        return some + (1.0 - some) * otherwise()
    least = float(np.quantile(samples, 0.98))
    if fall <= least:
        return float(np.mean(samples >= fall))
    # behind the samples as that of one number
    tail = float(special.fdtrc(1, freedom, fall))
    return 0.02 * tail / float(special.fdtrc(1, freedom, least)) if least > _NONE else min(tail, 0.02)


def orthonormal(columns: Array) -> Array:
    """An orthonormal basis of columns; some may be zero."""
    norms = np.linalg.norm(columns, axis=0)
    kept = norms > 1e-12 * norms.max(initial=0.0)
    found = np.linalg.qr(columns[:, kept] / norms[kept])[0]
    return np.asarray(found)


def likeness(rest: Array, basis: Array) -> tuple[float, float]:
    """The correlation of neighbouring residuals, and the probability of one as large if the noise is independent.

    By the moments of Durbin and Watson for residuals without what a basis explains.
    """
    points, count = basis.shape
    ratio = float(np.sum(np.diff(rest) ** 2) / np.sum(rest**2))

    def differences(columns: Array) -> Array:
        """The matrix of the squared differences times columns."""
        steps = np.diff(columns, axis=0)
        return np.concatenate([-steps[:1], steps[:-1] - steps[1:], steps[-1:]])

    once = differences(basis)
    inner = basis.T @ once
    trace = 2.0 * (points - 1) - np.trace(inner)
    squares = 6.0 * points - 8.0 - 2.0 * np.sum(once**2) + np.sum(inner**2)
    freedom = points - count
    mean = trace / freedom
    variance = 2.0 * (squares - trace * mean) / (freedom * (freedom + 2.0))
    return 1.0 - ratio / mean, float(scipy("special").ndtr((ratio - mean) / np.sqrt(variance)))
