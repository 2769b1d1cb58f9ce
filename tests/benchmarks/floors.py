"""Compute poses of the Stanford arm in numpy, as a reference for the benchmarks' times."""

import numpy as np
from numpy.typing import NDArray


def link(
    a: float, alpha: float, d: NDArray[np.float64], theta: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return link transforms in the standard convention."""
    c, s = np.cos(theta), np.sin(theta)
    ca, sa = np.cos(alpha), np.sin(alpha)
    zero, one = np.zeros_like(c), np.ones_like(c)
    rows = [
        [c, -s * ca, s * sa, a * c],
        [s, c * ca, -c * sa, a * s],
        [zero, sa * one, ca * one, d * one],
        [zero, zero, zero, one],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def stanford_pose(samples: int) -> NDArray[np.float64]:
    """Return the poses of the Stanford arm at random joint values."""
    q = np.random.default_rng(1).uniform(0.3, 1.0, (8, samples))
    zero = np.zeros(samples)
    half = np.pi / 2
    pose = link(0, -half, zero, q[0]) @ link(0, half, q[6], q[1]) @ link(0, 0, q[2], zero)
    return pose @ link(0, -half, zero, q[3]) @ link(0, half, zero, q[4]) @ link(0, 0, q[7], q[5])
