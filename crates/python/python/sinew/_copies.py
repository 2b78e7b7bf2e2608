"""Bodies whose copies differ."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def per_copy(values: ArrayLike) -> str:
    """One number a copy, (copies,), as scenes have it: for `per_copy` of a body, a load or a prescribed motion.

    >>> import sinew
    >>> sinew.per_copy([500, 1e3])
    'Values([500.0, 1000.0])'
    """
    numbers = np.asarray(values, np.float64)
    if numbers.ndim != 1 or not np.isfinite(numbers).all():
        raise ValueError(f"one finite number a copy, in an array of one axis; this one has the shape {numbers.shape}")
    return f"Values([{', '.join(map(repr, numbers.tolist()))}])"
