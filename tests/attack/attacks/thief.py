"""An observer on the path who drops nothing, and is faster.

He can: copy each datagram of the surgeon and have the copy at the patient up to 20 ms before the
original, from an address of his own; hand what the patient asks there to the surgeon, as if it
came from the patient; copy the surgeon's answer likewise.
Must hold: the patient's telegrams go on to the surgeon, all of them; it asks the thief at most once
a second; nobody holds.
"""

from __future__ import annotations

import heapq
import itertools
import select
import socket
import time
from collections import Counter
from collections.abc import Callable

from client import wire
from client.attack import Attack, Verdict
from client.programs import Address, Bench, Program

DELAY_S = 0.025
LEADS_MS = (0, 20, 1, 10, 2, 5)
SCRIPT = ("move -3 0.5", "press 4 1 600")


class Observer:
    """The relay between both sites, and the thief beside it."""

    def __init__(self, patient: Address, lead: Callable[[float], float | None]) -> None:
        """`lead`: by how much a copy is sooner [s]; None: no copy of this one."""
        self.patient, self.lead = patient, lead
        self.surgeon: Address | None = None
        self.front, self.back, self.thief = (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3)
        )
        for one, host in ((self.front, "127.0.0.1"), (self.back, "127.0.0.1"),
                          (self.thief, "127.0.0.3")):  # fmt: skip
            one.bind((host, 0))
            one.setblocking(False)
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.seen: Counter[str] = Counter()
        self.asked_at: list[float] = []
        self._order = itertools.count()
        self._waiting: list[tuple[float, int, socket.socket, bytes, Address]] = []
        self._began = time.monotonic()
        self.robs = False

    def _later(self, due: float, by: socket.socket, datagram: bytes, to: Address) -> None:
        heapq.heappush(self._waiting, (due, next(self._order), by, datagram, to))

    def _from_surgeon(self, datagram: bytes, source: Address, now: float) -> None:
        self.surgeon = source
        self._later(now + DELAY_S, self.back, datagram, self.patient)
        lead = self.lead(now - self._began) if self.robs else None
        if lead is not None and wire.kind_of(datagram) is not None:
            self._later(now + DELAY_S - lead, self.thief, datagram, self.patient)

    def _from_patient(self, datagram: bytes, now: float) -> None:
        self._later(now + DELAY_S, self.front, datagram, self.surgeon)
        if self.robs:
            self.seen["telegrams to the surgeon"] += datagram[0] == 0x80 | wire.DATA

    def _at_thief(self, datagram: bytes, now: float) -> None:
        if wire.kind_of(datagram) == wire.PATH:
            self.asked_at.append(now)
            self.seen["questions"] += 1
            self._later(now, self.front, datagram, self.surgeon)  # The hand-over.
        else:
            self.seen["telegrams to the thief"] += 1

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        end = time.monotonic() + seconds
        sockets = {
            self.front: self._from_surgeon,
            self.back: lambda d, _, now: self._from_patient(d, now),
            self.thief: lambda d, _, now: self._at_thief(d, now),
        }
        while (now := time.monotonic()) < end and not until():
            while self._waiting and self._waiting[0][0] <= now:
                _, _, by, datagram, to = heapq.heappop(self._waiting)
                by.sendto(datagram, to)
            due = self._waiting[0][0] if self._waiting else now + 0.05
            for one in select.select(list(sockets), [], [], max(0.0, min(due, end) - now))[0]:
                self._take(one, sockets[one])
        return until()

    @staticmethod
    def _take(one: socket.socket, then: Callable) -> None:
        for _ in range(64):
            try:
                datagram, source = one.recvfrom(65535)
            except OSError:
                return
            then(datagram, source, time.monotonic())

    def most_questions_in_a_second(self) -> int:
        return max(
            (sum(0 <= b - a < 0.999 for b in self.asked_at) for a in self.asked_at), default=0
        )


def _holds(*programs: Program) -> int:
    return sum(p.count("-> HOLD") + p.count("-> RETRACT") for p in programs)


def _steal(bench: Bench, lead: Callable[[float], float | None]) -> Verdict:
    patient = bench.patient()
    observer = Observer(patient.address(), lead)
    surgeon = bench.surgeon(observer.front.getsockname(), "--master", bench.script(*SCRIPT))
    observer.run(20, lambda: "-> ENGAGED" in surgeon.log)
    observer.run(2)
    before = _holds(patient, surgeon)
    observer.robs = True
    began = time.monotonic()
    observer.run(bench.seconds)
    took = time.monotonic() - began
    holds = _holds(patient, surgeon) - before
    share = observer.seen["telegrams to the surgeon"] / (1000 * took)
    most = observer.most_questions_in_a_second()
    engaged = "-> ENGAGED" in patient.log
    return Verdict(
        f"{observer.seen['questions']} questions to the thief, {most} at most in a second, "
        f"{patient.count('address is now')} moves, {holds} holds and retractions, "
        f"{100 * share:.0f} % of the telegrams on their way, "
        f"{observer.seen['telegrams to the thief']} at the thief",
        engaged and holds == 0 and share > 0.95 and most <= 1,
    )


def thief(bench: Bench) -> Verdict:
    """Another lead each second."""
    return _steal(bench, lambda t: LEADS_MS[int(t) % len(LEADS_MS)] * 1e-3)


def flapping(bench: Bench) -> Verdict:
    """Leads for 3 ms, then not for 3 ms, so that both addresses are newest in turn."""
    return _steal(bench, lambda t: 0.02 if t % 0.006 < 0.003 else None)


class Copier(Observer):
    """Copies each telegram from several addresses, in turn sooner and later than the surgeon."""

    LEADS_S = (0.02, 0.002, -0.002, -0.02)

    def __init__(self, patient: Address) -> None:
        super().__init__(patient, lambda _: None)
        self.ports = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in self.LEADS_S]
        for one in self.ports:
            one.bind(("127.0.0.3", 0))

    def _from_surgeon(self, datagram: bytes, source: Address, now: float) -> None:
        super()._from_surgeon(datagram, source, now)
        if not self.robs or wire.kind_of(datagram) != wire.DATA:
            return
        for lead, by in zip(self.LEADS_S, self.ports, strict=True):
            self._later(now + DELAY_S - lead, by, datagram, self.patient)

    def change_address(self) -> None:
        """The surgeon is seen elsewhere; what goes to the old address is lost."""
        self.back.close()
        self.back = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.back.bind(("127.0.0.1", 0))
        self.back.setblocking(False)
        self._waiting = [
            (due, order, self.back if by.fileno() < 0 else by, datagram, to)
            for due, order, by, datagram, to in self._waiting
        ]


def ports(bench: Bench) -> Verdict:
    """The surgeon's address changes every two seconds, beside four addresses of a copier."""
    patient = bench.patient()
    copier = Copier(patient.address())
    surgeon = bench.surgeon(copier.front.getsockname(), "--master", bench.script(*SCRIPT))
    copier.run(20, lambda: "-> ENGAGED" in surgeon.log)
    copier.run(2)
    copier.robs = True
    copier.run(1)
    late = []
    for _ in range(int(bench.seconds / 2)):
        moved = patient.count("address is now")
        began = time.monotonic()
        copier.change_address()
        followed = copier.run(2, lambda moved=moved: patient.count("address is now") > moved)
        took = time.monotonic() - began
        late.append(took if followed else 2.0)
        copier.run(max(0.0, 2 - took))
    limit = 2 * DELAY_S + 0.2
    good = sum(took <= limit for took in late)
    return Verdict(
        f"followed within {1000 * max(late):.0f} ms at most, {good} of {len(late)} within "
        f"{1000 * limit:.0f} ms, {patient.count('address is now')} moves, "
        f"{_holds(patient, surgeon)} holds and retractions",
        bool(late) and good == len(late) and patient.count("address is now") == len(late),
    )


ATTACKS = [
    Attack("thief-ports", "copies from four addresses while the surgeon's changes", ports, 12, 40),
    Attack("thief", "copies 0 to 20 ms sooner, and the question handed over", thief, 12, 60),
    Attack("thief-flapping", "the same, every other 3 ms", flapping, 12, 60),
]
