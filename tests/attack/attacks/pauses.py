"""The machine stands still: one of the two processes is stopped and goes on, again and again.

It can: stop either process for 1 ms to 5 s, in any phase, as a suspended machine or swap would.
Must hold: no kick, and no energy from the law but its bound; nobody dies; the session goes on. What
a hand that moves meanwhile does to the stiffest spring of a law is no kick. What the held force
does while its process stands still no law can take back: it counts as debt, which the hand pays
before the law may give again (docs/safety.md).
"""

from __future__ import annotations

import math
import os
import random
import signal
import time
from dataclasses import dataclass
from pathlib import Path

from client.attack import Attack, Verdict
from client.programs import Bench
from client.session import ENGAGED
from client.session_file import messages

ENERGY_MAX_MJ = 1.05  # of mmt, with a margin of a tick
FORCE_STEP_MAX_N = 0.5  # in 10 ms
STIFFEST_N_PER_M = 650.0  # the spring of the laws' tanks
LONGEST, SHORTEST = 5.0, 0.001  # [s]
LATE_NS = 1_500_000
DRAWS_A_SECOND = 0.7  # pauses, and the time between them


@dataclass
class Account:
    """What a session file says that the hand got, tick by tick."""

    given: float = 0.0  # [J], of the law; below 0: the hand has paid
    given_max: float = 0.0
    debt: float = 0.0  # [J], given by a held force and not yet paid back
    held_max: float = 0.0  # [J], in one pause
    step_max: float = 0.0  # [N] in 10 ms
    late: int = 0
    engaged: int = 0

    def add(self, gained: float, late: bool) -> None:
        if late and gained > 0:
            self.debt += gained
            self.held_max = max(self.held_max, gained)
        elif gained < 0:
            paid = min(self.debt, -gained)
            self.debt -= paid
            self.given += gained + paid
        else:
            self.given += gained
        self.given_max = max(self.given_max, self.given)


def unexplained(change: float, way: float) -> float:
    """[N] of a change of force, beyond what the way does: in where it grows, out where it falls."""
    along = max(0.0, way if change > 0 else -way)
    return max(0.0, abs(change) - STIFFEST_N_PER_M * along)


def account_of(path: Path) -> Account:
    account = Account()
    before = None
    recent: list[tuple[int, float, float]] = []
    for at, tick in messages(path, "surgeon/tick"):
        position, force = tick["position_m"], tick["force_n"]
        account.engaged += tick["state"] == ENGAGED
        stood = position
        if before is not None:
            late = at - before[0] > LATE_NS
            account.late += late
            account.add(-force * (position - before[1]), late)
            # The force of a late tick is still that of where the hand was before.
            stood = before[1] if late else position
        before = at, position
        recent = [one for one in recent if at - one[0] <= 10_000_000]
        steps = [unexplained(force - f, position - p) for _, f, p in recent]
        recent.append((at, force, stood))
        account.step_max = max(account.step_max, *steps, 0.0)
    return account


def pauses(bench: Bench) -> Verdict:
    draw = random.Random(bench.seed)
    file = bench.work / "surgeon.mcap"
    patient = bench.patient()
    taps = ("move -3 0.5", "taps 900 5 0.8 0.1")
    surgeon = bench.surgeon(patient.address(), "--session-file", file, "--master", bench.script(*taps))
    time.sleep(2)
    count = bench.count or max(5, int(bench.seconds * DRAWS_A_SECOND))
    longest = 0.0
    for _ in range(count):
        span = SHORTEST * math.exp(draw.random() * math.log(LONGEST / SHORTEST))
        longest = max(longest, span)
        process = draw.choice([patient, surgeon])
        os.kill(process.pid, signal.SIGSTOP)
        time.sleep(span)
        os.kill(process.pid, signal.SIGCONT)
        time.sleep(0.2 + draw.random())
    alive = patient.running and surgeon.running
    surgeon.finish()
    patient.finish()
    got = account_of(file)
    held = (
        alive
        and got.given_max * 1e3 <= ENERGY_MAX_MJ
        and got.step_max <= FORCE_STEP_MAX_N
        and got.engaged > 1000
    )
    return Verdict(
        f"{count} pauses of up to {longest:.1f} s, {got.late} late ticks, {got.engaged} ticks "
        f"engaged; the law gave {got.given_max * 1e3:.2f} mJ, a held force {got.held_max * 1e3:.2f} "
        f"mJ at most, {got.step_max:.2f} N in 10 ms",
        held,
    )


ATTACKS = [Attack("pauses", "either process is stopped for 1 ms to 5 s, and goes on", pauses, 10, 75)]
