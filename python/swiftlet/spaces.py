"""The spaces of swiftlet.gym where Gymnasium is not installed: the part of its Box that agents use."""
from typing import Any, Optional, Tuple

import numpy as np
from numpy.typing import NDArray


class Box:
    """Vectors between two bounds, with the members of gymnasium.spaces.Box of the same names."""

    def __init__(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> None:
        self.low = np.array(low, dtype=np.float64)
        self.high = np.array(high, dtype=np.float64)
        self.dtype = self.low.dtype
        self.shape: Tuple[int, ...] = self.low.shape
        self._random = np.random.default_rng()

    def seed(self, seed: Optional[int] = None) -> None:
        """Begins the sequence of sample() anew."""
        self._random = np.random.default_rng(seed)

    def sample(self) -> NDArray[np.float64]:
        """Uniform between the bounds; along an unbounded side normal, with deviation 1."""
        bounded = np.isfinite(self.low) & np.isfinite(self.high)
        low = np.where(bounded, self.low, 0.0)
        high = np.where(bounded, self.high, 0.0)
        drawn: NDArray[np.float64] = np.where(
            bounded, self._random.uniform(low, high), self._random.standard_normal(self.shape)
        )
        return drawn

    def contains(self, x: Any) -> bool:
        """True for an array of this shape between the bounds."""
        x = np.asarray(x)
        return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

    def __contains__(self, x: Any) -> bool:
        return self.contains(x)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Box) and np.array_equal(self.low, other.low) and np.array_equal(self.high, other.high)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"
