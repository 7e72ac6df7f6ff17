"""Chance that falls the same way for the same seed, on any machine and any version of Python."""

import math
import random


class Dice:
    def __init__(self, seed):
        self._random = random.Random(seed).random  # the one function whose sequence Python promises to keep

    def chance(self, share):
        return self._random() < share

    def number(self, low, high):
        return self.rounded(low + (high - low) * self._random())

    def spread(self, low, high):
        """Of any size alike: as often between 0.01 and 0.1 as between 10 and 100."""
        return self.rounded(math.exp(math.log(low) + (math.log(high) - math.log(low)) * self._random()))

    def whole(self, low, high):
        return low + int((high - low + 1) * self._random())

    def pick(self, choices):
        return choices[int(len(choices) * self._random())]

    def weighed(self, choices):
        """choices: {value: weight}"""
        at = self._random() * sum(choices.values())
        for value, weight in choices.items():
            at -= weight
            if at < 0:
                return value
        return value

    def vector(self, size):
        return [self.number(-size, size) for _ in range(3)]

    @staticmethod
    def rounded(value):
        """Four digits: enough for chance, and short in a scene that somebody is to read."""
        return float(f"{value:.4g}")
