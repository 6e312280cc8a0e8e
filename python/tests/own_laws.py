"""Adhesion laws written in Python, for tests."""

import numpy as np


class Exponential:
    """The exponential law, written in Python."""

    def __init__(self, work_of_adhesion, range):
        self.work_of_adhesion, self.range = work_of_adhesion, range
        self.calls = []

    def energy(self, gap):
        self.calls.append(gap.size)
        return -self.work_of_adhesion * np.exp(-gap / self.range)

    def traction(self, gap):
        return self.work_of_adhesion / self.range * np.exp(-gap / self.range)

    def slope(self, gap):
        return -self.work_of_adhesion / self.range**2 * np.exp(-gap / self.range)
