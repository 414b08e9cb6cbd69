"""Somebody who sees every datagram and wants to know which belong together.

He can: note all of them, on both sides of a change of address.
Must hold: what a header hides looks like chance. No bit of it is set more often than not, none
follows from the datagram before, and no connection id or number can be read from it.
"""

from __future__ import annotations

import math
import struct

from attacks.thief import SCRIPT, Observer
from client import wire
from client.attack import Attack, Verdict
from client.programs import Bench

Z_MAX = 5.0  # standard deviations; by chance one round in some 10,000 has a bit beyond it


class Listener(Observer):
    """Keeps the hidden parts of the telegrams of each way."""

    def __init__(self, patient) -> None:
        super().__init__(patient, lambda t: None)
        self.kept: dict[str, list[bytes]] = {"up": [], "down": []}
        self.listens = False

    def _note(self, way: str, datagram: bytes) -> None:
        if self.listens and wire.kind_of(datagram) == wire.DATA:
            self.kept[way].append(datagram[wire.CLEAR_BYTES : wire.HEADER_BYTES])

    def _from_surgeon(self, datagram: bytes, source, now: float) -> None:
        self._note("up", datagram)
        super()._from_surgeon(datagram, source, now)

    def _from_patient(self, datagram: bytes, now: float) -> None:
        self._note("down", datagram)
        super()._from_patient(datagram, now)


def _z(hits: int, of: int) -> float:
    """How far a fair coin's count lies from its half."""
    return abs(hits - of / 2) / (math.sqrt(of) / 2)


def _bits(parts: list[bytes]) -> float:
    """The worst of: a bit that is mostly set, or mostly as it was one datagram before."""
    numbers = [int.from_bytes(part, "big") for part in parts]
    steps = [a ^ b for a, b in zip(numbers, numbers[1:])]
    size = 8 * len(parts[0])
    return max(
        _z(sum(value >> bit & 1 for value in values), len(values))
        for values in (numbers, steps)
        for bit in range(size)
    )


def _rises(parts: list[bytes]) -> float:
    """Packet numbers that could be read would always rise; of chance every second one does, and
    whether two neighbours do is not independent: a third of the variance of a coin."""
    numbers = [struct.unpack(">IQ", part)[1] for part in parts]
    rises = sum(b > a for a, b in zip(numbers, numbers[1:]))
    return _z(rises, len(numbers) - 1) * math.sqrt(3)


def observer(bench: Bench) -> Verdict:
    patient = bench.patient()
    listener = Listener(patient.address())
    surgeon = bench.surgeon(listener.front.getsockname(), "--master", bench.script(*SCRIPT))
    listener.run(20, lambda: "-> ENGAGED" in surgeon.log)
    listener.run(0.5)
    listener.listens = True
    listener.run(bench.seconds)
    up, down = listener.kept["up"], listener.kept["down"]
    fewest = min(len(up), len(down))
    if fewest < 500:
        return Verdict(f"only {fewest} telegrams came by", False)
    bits, order = max(_bits(up), _bits(down)), max(_rises(up), _rises(down))
    again = len(up) + len(down) - len({p[:4] for p in up + down})
    by_chance = (len(up) + len(down)) ** 2 / 2**33
    return Verdict(
        f"{len(up)} and {len(down)} telegrams, hidden bits at most {bits:.1f} standard deviations "
        f"from chance, their order {order:.1f}, {again} connection ids seen twice",
        bits < Z_MAX and order < Z_MAX and again <= by_chance + 5,
    )


ATTACKS = [Attack("observer", "who listens cannot tell a session's datagrams apart", observer, 5, 30)]
