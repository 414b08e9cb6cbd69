"""Everything at once, for long: a session that is recorded, gets new keys every few seconds and
whose surgeon stands behind a translator with ever new addresses; others attack every other while.

They can: send junk to both sites, half of it in the other's name; copy the surgeon's telegrams
sooner than they come and hand over the questions; show cookies and finish nothing; call with good
keys and lie in their Hellos.
Must hold: one session, whole files; memory and descriptors stay as they were once warm; at most
0.5 more ticks in 1,000 are missed with attacks than without.
"""

from __future__ import annotations

import multiprocessing
import os
import random
import select
import signal
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from client import wire
from client.attack import Attack, Verdict, learn_settings
from client.mutation import Mutator
from client.programs import Address, Bench, Program, wait_for
from client.session_file import instants
from client.site import Surgeon

from attacks.cookies import Stranger
from attacks.hostile import Ear, junk
from attacks.mutations import ask_again, edit_hellos
from attacks.thief import Observer

REKEY_S = 5
ROAM_S = 3.0
ADDRESSES = 24  # of the translator, in turn
JUNK_PER_S = 1000  # at both sites together
COOKIES_PER_S = 500
COOKIE_HOSTS = 20
LEAD_S = 0.005  # of the thief's copies
SETTLE_S = 0.2  # of each stretch: what the one before left behind
MISSED_MORE_MAX = 0.5  # per 1,000
GROWTH_MAX_KB = 1024  # of both sites in a short run; beyond 20 minutes:
GROWTH_MAX_KB_PER_HOUR = 100
STOLEN_MAX = 0.005  # of the machine, by its other guests


@dataclass(frozen=True)
class Stretches:
    """Quiet and attacked in turn, all of one length, from `began` on the wall clock."""

    began: float
    length: float
    warm: int  # so many first ones count for nothing
    count: int

    @staticmethod
    def of(seconds: float) -> Stretches:
        length = min(15.0, max(2.0, seconds / 10))
        pairs = max(2, round(seconds / length / 2))
        warm = min(pairs - 1, 1 + int(min(300.0, seconds / 4) / length / 2))
        return Stretches(time.time(), length, 2 * warm, 2 * pairs)

    @property
    def measured(self) -> range:
        return range(self.warm, self.count)

    def attacked(self) -> bool:
        which = int((time.time() - self.began) / self.length)
        return which % 2 == 1 and which < self.count

    def bounds(self, which: int) -> tuple[float, float]:
        begin = self.began + which * self.length
        return begin + SETTLE_S, begin + self.length

    def await_end_of(self, which: int) -> None:
        time.sleep(max(0.0, self.bounds(which)[1] - time.time()))


class World:
    """What the attackers' processes share: sockets, addresses, counts."""

    def __init__(self, patient: Address) -> None:
        self.patient = patient
        self.backs = [_socket(f"127.0.5.{i + 1}") for i in range(ADDRESSES)]
        self.tell, self.hear = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.tell.setblocking(False)
        self.hear.setblocking(False)
        self.back = multiprocessing.Value("i", 0)
        self.surgeon_port = multiprocessing.Value("i", 0)
        self.translator = Translator(self)
        names = ("moves", "hellos", "copies", "questions", "junk", "cookies", "calls", "lies")
        self.counts = {name: multiprocessing.Value("q", 0) for name in names}


def _socket(host: str) -> socket.socket:
    one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    one.bind((host, 0))
    one.setblocking(False)
    one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
    return one


class Translator(Observer):
    """The surgeon's way to the patient, and the thief on it."""

    def __init__(self, world: World) -> None:
        super().__init__(world.patient, lambda t: LEAD_S)
        self.back.close()
        self.world, self.back = world, world.backs[0]

    def _from_surgeon(self, datagram: bytes, source: Address, now: float) -> None:
        super()._from_surgeon(datagram, source, now)
        kind = wire.kind_of(datagram)
        counts = self.world.counts
        self.world.surgeon_port.value = source[1]
        counts["hellos"].value += kind == wire.CONTROL
        counts["copies"].value += self.robs and kind is not None
        try:
            self.world.tell.send(datagram)
        except OSError:
            pass  # The junk has enough.

    def move(self) -> None:
        self.world.counts["moves"].value += 1
        which = self.world.back.value = (self.world.back.value + 1) % ADDRESSES
        self.back = self.world.backs[which]
        self._take(self.back, lambda *_: None)  # What came here since the last time.

    def live(self, stretches: Stretches | None) -> None:
        moved = time.monotonic()
        while True:
            self.robs = stretches is not None and stretches.attacked()
            self.run(0.05)
            self.world.counts["questions"].value = self.seen["questions"]
            if stretches is not None and time.monotonic() - moved > ROAM_S:
                moved = time.monotonic()
                self.move()


def _send(by: socket.socket, datagram: bytes, to: Address) -> None:
    try:
        by.sendto(datagram, to)
    except OSError:
        pass


def _paced(stretches: Stretches, per_s: float, act: Callable[[], None]) -> None:
    """While there is an attack; what was not done in time is left out."""
    due = time.monotonic()
    while True:
        if not stretches.attacked():
            time.sleep(0.02)
            due = time.monotonic()
            continue
        act()
        due += 1 / per_s
        now = time.monotonic()
        due = max(due, now - 0.05)
        if due - now > 0.002:
            time.sleep(due - now)


def _throw_junk(world: World, stretches: Stretches, seed: int) -> None:
    ear = Ear()
    made = junk(random.Random(seed), ear)
    strangers = [_socket(f"127.0.4.{i + 1}") for i in range(16)]

    def act() -> None:
        while select.select([world.hear], [], [], 0)[0]:
            ear.listen(world.hear.recv(65535))
        which = world.counts["junk"].value
        back = world.backs[world.back.value]
        by = back if which % 4 == 1 else strangers[which // 4 % len(strangers)]
        if which % 2:
            _send(by, next(made), world.patient)
        else:  # The surgeon hears nobody but the translator's address.
            _send(world.translator.front, next(made), ("127.0.0.1", world.surgeon_port.value))
        world.counts["junk"].value += 1

    _paced(stretches, JUNK_PER_S, act)


def _show_cookies(world: World, stretches: Stretches) -> None:
    strangers: list[Stranger] = []
    while True:
        if not stretches.attacked():
            for one in strangers:
                one.socket.close()
            strangers = []
            time.sleep(0.02)
            continue
        if not strangers:
            strangers = [Stranger(f"127.0.6.{i + 1}", world.patient) for i in range(COOKIE_HOSTS)]
        strangers[world.counts["cookies"].value % COOKIE_HOSTS].show()
        world.counts["cookies"].value += 1
        time.sleep(1 / COOKIES_PER_S)


def _call_and_lie(world: World, stretches: Stretches, identity, settings, seed: int) -> None:
    mutator = Mutator(seed)
    while True:
        if not stretches.attacked():
            time.sleep(0.02)
            continue
        with Surgeon(identity, world.patient, settings, ("127.0.7.1", 0)) as site:
            edit_hellos(site, mutator)
            site.on_tick = lambda now: ask_again(site)
            site.run(0.5, lambda: site.established)
            world.counts["calls"].value += bool(site.keys)
            world.counts["lies"].value += site.counts["edited"]


def _begin(work: Callable, *arguments) -> multiprocessing.Process:
    def alone() -> None:
        for ended in (signal.SIGINT, signal.SIGTERM):
            signal.signal(ended, signal.SIG_DFL)
        work(*arguments)

    process = multiprocessing.get_context("fork").Process(target=alone, daemon=True)
    process.start()
    return process


def _descriptors(program: Program) -> int:
    """The least of some looks: a site asks for its own address on a socket of a moment."""
    folder = Path(f"/proc/{program.pid}/fd")
    looks = []
    for _ in range(10):
        looks.append(len(os.listdir(folder)))
        time.sleep(0.005)
    return min(looks)


def _stolen() -> tuple[int, int]:
    """Ticks of the machine that other guests had, and all."""
    told = [int(n) for n in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    return told[7], sum(told)


def _missed(file: Path, topic: str, stretches: Stretches) -> list[tuple[int, int]]:
    """Of each stretch: ticks that should have been, and that were not."""
    bounds = [tuple(int(s * 1e9) for s in stretches.bounds(k)) for k in range(stretches.count)]
    first, last, count = ([0] * stretches.count for _ in range(3))
    for at in instants(file, topic):
        which = int((at * 1e-9 - stretches.began) / stretches.length)
        if 0 <= which < stretches.count and bounds[which][0] <= at < bounds[which][1]:
            first[which] = first[which] or at
            last[which], count[which] = at, count[which] + 1
    due = [round((b - a) / 1e6) + 1 if n else 0 for a, b, n in zip(first, last, count)]
    return [(d, d - n) for d, n in zip(due, count)]


@dataclass
class Watch:
    """Memory and descriptors of both sites, and what of the machine was taken, by stretch."""

    sites: list[Program]
    memory: list[int]
    descriptors: list[list[int]]
    stolen: list[float]

    def look(self, stretches: Stretches) -> None:
        before = _stolen()
        for which in range(stretches.count):
            stretches.await_end_of(which)
            if not all(site.running for site in self.sites):
                return
            after = _stolen()
            self.stolen.append((after[0] - before[0]) / max(1, after[1] - before[1]))
            before = after
            self.memory.append(sum(site.resident_kb() for site in self.sites))
            self.descriptors.append([_descriptors(site) for site in self.sites])


def _per_thousand(told: list[tuple[int, int]], which: list[int]) -> float:
    due = sum(told[k][0] for k in which)
    return 1e3 * sum(told[k][1] for k in which) / max(1, due)


def _judge(
    bench: Bench, watch: Watch, stretches: Stretches, files: dict[str, Path], counts: dict[str, int]
) -> Verdict:
    wrong: list[str] = []
    whole = len(watch.memory) == stretches.count
    grown = watch.memory[-1] - watch.memory[stretches.warm - 1] if whole else 0
    hours = stretches.length * len(stretches.measured) / 3600
    limit = GROWTH_MAX_KB if hours < 1 / 3 else 1 + GROWTH_MAX_KB_PER_HOUR * hours
    fds = watch.descriptors[stretches.warm - 1 :] if whole else []
    # Pairs in which other guests took the machine say nothing, unless that is most of them.
    pairs = [k for k in stretches.measured if k % 2 == 0] if whole else []
    kept = [k for k in pairs if max(watch.stolen[k : k + 2]) <= STOLEN_MAX]
    kept = kept if 3 * len(kept) >= len(pairs) else pairs
    ticks = []
    for site, file in files.items():
        told = _missed(file, f"{site}/tick", stretches)
        quiet = _per_thousand(told, kept)
        attacked = _per_thousand(told, [k + 1 for k in kept])
        ticks.append(f"{site} {attacked:.2f} beside {quiet:.2f}")
        if attacked > quiet + MISSED_MORE_MAX and not bench.sanitized:
            wrong.append(f"{site} misses ticks")
    for site in watch.sites:
        report = site.report
        if report.get("sessions") != 1 or report.get("records_dropped") != 0:
            wrong.append(f"{report.get('site')}: {report.get('sessions')} sessions")
        if report.get("recording_fault") or site.process.poll() not in (0, 4):
            wrong.append(f"{report.get('site')} ended with {site.process.poll()}")
    steady = whole and all(min(f) == max(f) for f in zip(*fds))
    tried = all(counts[name] for name in counts)
    held = not wrong and whole and steady and tried and bench.memory_is_kept(grown, limit)
    told = ", ".join(f"{count} {name}" for name, count in counts.items())
    return Verdict(
        f"{stretches.count * stretches.length:.0f} s, memory {grown:+d} kB in the last "
        f"{hours * 3600:.0f} s, descriptors {fds[0] if fds else '?'} -> {fds[-1] if fds else '?'}, "
        f"missed of 1,000 with attacks and without: {', '.join(ticks)} "
        f"({len(kept)} of {len(pairs)} pairs); {told}" + "".join(f"; {w}" for w in wrong),
        held,
    )


def soak(bench: Bench) -> Verdict:
    settings, identity = learn_settings(bench), bench.identity("surgeon")
    files = {site: bench.work / f"{site}.mcap" for site in ("surgeon", "patient")}
    rekey = ("--set", f"link.rekey_after_s={REKEY_S}")
    patient = bench.patient("--session-file", files["patient"], *rekey)
    world = World(patient.address())
    taps = ["taps 5 4 1 0.5"] * (int(bench.seconds) // 3 + 20)
    processes = [_begin(world.translator.live, None)]
    surgeon = bench.surgeon(
        world.translator.front.getsockname(), "--session-file", files["surgeon"], *rekey,
        "--master", bench.script("move -3 0.5", *taps),
    )  # fmt: skip
    try:
        if not wait_for(lambda: "-> ENGAGED" in surgeon.log, 20):
            raise RuntimeError(f"no session: {surgeon.log}")
        stretches = Stretches.of(bench.seconds)
        processes.pop().kill()
        processes += [
            _begin(world.translator.live, stretches),
            _begin(_throw_junk, world, stretches, bench.seed),
            _begin(_show_cookies, world, stretches),
            _begin(_call_and_lie, world, stretches, identity, settings, bench.seed),
        ]
        watch = Watch([surgeon, patient], [], [], [])
        watch.look(stretches)
        died = sum(not process.is_alive() for process in processes)
        surgeon.finish()
        patient.finish()
    finally:
        for process in processes:
            process.kill()
    if died:
        raise RuntimeError(f"{died} attackers ended by themselves")
    counts = {name: count.value for name, count in world.counts.items()}
    return _judge(bench, watch, stretches, files, counts)


ATTACKS = [
    Attack("soak", "all of them at once and in turn with quiet, for long", soak, 20, 20)
]
