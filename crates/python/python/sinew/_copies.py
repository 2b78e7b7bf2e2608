"""Bodies whose copies differ."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def per_copy(values: ArrayLike) -> str:
    """One number a copy, (copies,), or one vector a copy, (copies, 3), as scenes have it: for `per_copy` of a body, a
    load or a prescribed motion.

    >>> import sinew
    >>> sinew.per_copy([500, 1e3])
    'Values([500.0, 1000.0])'
    >>> sinew.per_copy([[1, 0, 0], [0, 0, 2]])
    'Axes(x: Values([1.0, 0.0]), y: Values([0.0, 0.0]), z: Values([0.0, 2.0]))'
    """
    numbers = np.asarray(values, np.float64)
    if not np.isfinite(numbers).all() or not (numbers.ndim == 1 or (numbers.ndim == 2 and numbers.shape[1] == 3)):
        raise ValueError(
            f"one finite number or vector a copy, in an array (copies,) or (copies, 3); this one is {numbers.shape}"
        )
    if numbers.ndim == 1:
        return f"Values([{', '.join(map(repr, numbers.tolist()))}])"
    axes = (f"{axis}: {per_copy(numbers[:, i])}" for i, axis in enumerate("xyz"))
    return f"Axes({', '.join(axes)})"
