"""The truth's random numbers: each belongs to its name, so that no other draw can move it."""

import zlib

import numpy as np


class Draws:
    """Draws by name from one seed, remembered in `taken` for the truth file."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.taken: dict[str, float] = {}

    def stream(self, name: str) -> np.random.Generator:
        """A generator of its own for `name`."""
        return np.random.default_rng([self.seed, zlib.crc32(name.encode())])

    def around(self, name: str, nominal: float, log_sd: float) -> float:
        """A value lognormal around `nominal`, cut off at two standard deviations."""
        value = nominal * float(np.exp(log_sd * np.clip(self.stream(name).standard_normal(), -2.0, 2.0)))
        return self.taken.setdefault(name, value)

    def normal(self, name: str, sd: float, limit: float = np.inf) -> float:
        """A value normal around 0, cut off at +-limit."""
        value = float(np.clip(sd * self.stream(name).standard_normal(), -limit, limit))
        return self.taken.setdefault(name, value)
