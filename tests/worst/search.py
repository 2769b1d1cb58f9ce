"""Evolutionary search: keep the costliest request bodies, and change them at random."""

import random
import time
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from tests.worst.entry_points import Attack, Target, floor_seconds
from tests.worst.mutations import Mutator

# The number of bodies kept for each entry point and exercise.
KEPT = 6
FLOOR_AFTER = 200
# A body below this share of the cheapest kept one is not measured again.
NEARLY = 0.8


@dataclass(frozen=True)
class Found:
    """A request body and its measured cost."""

    ratio: float
    attack: Attack
    status: int


class Search:
    """Keeps the costliest request bodies for each entry point and exercise."""

    def __init__(self, target: Target, seed: int, cells: list[str]) -> None:
        self.kept: dict[tuple[str, str], list[Found]] = defaultdict(list)
        self.tried = 0
        self._target = target
        self._choose = random.Random(seed)
        self._mutator = Mutator(self._choose, cells)
        self._floor = floor_seconds()

    def measured(self, attack: Attack, rounds: int = 2) -> Found:
        if rounds > 1:
            self._floor = floor_seconds()
        seconds, status = self._target.seconds(attack, rounds)
        return Found(seconds / self._floor, attack, status)

    def tried_out(self, attack: Attack) -> None:
        """Measure a body, and keep it if it is one of the costliest."""
        self.tried += 1
        if self.tried % FLOOR_AFTER == 0:
            self._floor = floor_seconds()
        kept = self.kept[attack.entry, attack.exercise]
        least = kept[-1].ratio if len(kept) == KEPT else 0.0
        found = self.measured(attack, 1)
        if found.ratio > NEARLY * least:
            again = self.measured(attack, 1)
            found = min(found, again, key=lambda each: each.ratio)
        if found.ratio > least:
            kept.append(found)
            kept.sort(key=lambda each: -each.ratio)
            del kept[KEPT:]

    def evolve(self, begin: Iterable[Attack], until: float, entry: str = "") -> None:
        """Search for costly bodies until a given time."""
        first = list(begin)
        self._choose.shuffle(first)
        for attack in first:
            if time.monotonic() > until:
                return
            if entry in ("", attack.entry):
                self.tried_out(attack)
        while time.monotonic() < until:
            place = self._place()
            kept = self.kept[place]
            parent = kept[min(int(self._choose.expovariate(0.6)), len(kept) - 1)]
            others = [
                each.attack for key in self.kept if key[1] == place[1] for each in self.kept[key]
            ]
            self.tried_out(self._mutator.mutated(parent.attack, others))

    def _place(self) -> tuple[str, str]:
        entries = sorted({entry for entry, _ in self.kept})
        entry = self._choose.choice(entries)
        places = [place for place in self.kept if place[0] == entry and self.kept[place]]
        places.sort(key=lambda place: -self.kept[place][0].ratio)
        if self._choose.random() < 0.3:
            return self._choose.choice(places)
        return places[min(int(self._choose.expovariate(0.35)), len(places) - 1)]

    def costliest(self, entry: str, most: int) -> list[Found]:
        found = [kept[0] for (name, _), kept in self.kept.items() if name == entry and kept]
        return sorted(found, key=lambda each: -each.ratio)[:most]
