"""A peer with good keys edits its messages at random before it seals them.

It can: change, drop, repeat, reorder, retype every field of every message, and bytes as such.
Must hold: the program lives, the session goes on, memory does not grow.
"""

from __future__ import annotations

import time

from client import wire
from client.attack import Attack, Verdict, learn_settings
from client.mutation import Mutator
from client.programs import Bench, Program
from client.schema import BYTES, MESSAGES, encode, unpack
from client.session import STOPPED
from client.site import Patient, Site, Surgeon

(SITE,) = (e for e in MESSAGES["Telegram"] if e.name == "site")
(STATE,) = (e for e in MESSAGES[SITE.kind] if e.name == "state")
PAYLOADS = ("wave", "tdpa", "model")


def _everything(site: Site, which: int) -> dict:
    """A telegram with each field of the schema."""
    ones = {
        name: {e.name: 1 if e.kind in ("enum", "uint32") else 1e-3 for e in MESSAGES[name]}
        for name in ("Wave", "Tdpa", "Model", "Depth", "Map")
    }
    told = site.telegram()
    told["site"]["depth"] = ones["Depth"]
    told["site"]["map"] = ones["Map"]
    told["site"]["x_m"] = told["site"]["y_m"] = 1e-3
    motion = {"position_m": -0.01, "velocity_m_per_s": 1e-3, "force_n": 1e-3}
    payload = PAYLOADS[which % len(PAYLOADS)]
    told["sample"] = motion | {payload: ones[payload.capitalize()]}
    told["sample_first_earlier"] = motion | {"wave": ones["Wave"]}
    told["sample_second_earlier"] = motion | {"wave": ones["Wave"]}
    return told


def _says_stopped(message: bytes) -> bool:
    """Whether any reading of it could be the state that ends a surgeon's script."""
    try:
        inner = [f[2] for f in unpack(message) if f[0] == SITE.number and f[1] == BYTES]
        states = [f[2] for one in inner for f in unpack(bytes(one)) if f[0] == STATE.number]
    except (ValueError, IndexError, KeyError):
        return False  # No telegram at all.
    return any(isinstance(s, int) and s & 0xFFFFFFFF == STOPPED for s in states)


def _telegram_mutant(site: Site, count: int, mutator: Mutator) -> bytes:
    told = encode("Telegram", _everything(site, count))
    while _says_stopped(mutant := mutator.mutate("Telegram", told)):
        pass
    return mutant


def _mutant(site: Site, count: int, mutator: Mutator) -> tuple[int, bytes]:
    """Of each ten eight telegrams; a goodbye says another session, or there would be none left."""
    if count % 10 < 8:
        return wire.DATA, _telegram_mutant(site, count, mutator)
    if count % 10 == 8:
        told = wire.path_message(count // 10 % 2, mutator.random.randbytes(wire.PATH_REST_BYTES))
        return wire.PATH, mutator.mutate("path", told)
    bye = {"session_id": 1, "peer_session_id": 2, "reason": 1, "text": b"a sentence"}
    return wire.CLOSE, mutator.mutate("Bye", encode("Bye", bye))


def _attack(bench: Bench, site: Site, program: Program) -> Verdict:
    mutator = Mutator(bench.seed)
    sent = 0

    def lie(now: float) -> None:
        nonlocal sent
        for _ in range(4):
            if site.session:
                site.send(site.seal(*_mutant(site, sent, mutator)))
                sent += 1

    site.run(15, lambda: site.established)
    site.run(1)
    memory, site.on_tick = program.resident_kb(), lie
    site.run(bench.seconds, lambda: bench.count is not None and sent >= bench.count)
    site.on_tick = lambda now: None
    site.run(0.3)
    before = site.counts["telegrams"]
    site.run(0.5)
    spoke = site.counts["telegrams"] - before
    grown = program.resident_kb() - memory if program.running else 0
    sessions = site.counts["sessions"]
    code = program.finish()
    refused = program.report.get("rejected", {}).get("malformed", 0)
    return Verdict(
        f"{sent} mutations, {refused} refused as malformed, {spoke} telegrams in the last 0.5 s, "
        f"{sessions} session, memory {grown:+d} kB, exit code {code}",
        sent >= (bench.count or 1) and spoke > 250 and sessions == 1 and bench.memory_is_kept(grown)
        and code in (0, 4) and refused > sent / 5,
    )  # fmt: skip


def of_patient(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    patient = bench.patient()
    with Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        return _attack(bench, surgeon, patient)


def of_surgeon(bench: Bench) -> Verdict:
    with Patient(bench.identity("patient")) as patient:
        surgeon = bench.surgeon(patient.address, "--master", bench.script("hold 600"))
        return _attack(bench, patient, surgeon)


def edit_hellos(site: Site, mutator: Mutator) -> None:
    """Each Hello of the site, whenever it says one."""
    seal = site.seal_control

    def edited(keys: wire.Keys, message: bytes) -> bytes:
        if mutator.random.random() < 0.8:
            site.counts["edited"] += 1
            message = mutator.mutate("Hello", message)
        return seal(keys, message)

    site.seal_control = edited


class _Round:
    """Half of the time, or so many edited Hellos."""

    def __init__(self, bench: Bench) -> None:
        self.end = time.monotonic() + bench.seconds / 2
        self.count = bench.count
        self.sent = 0

    def goes_on(self) -> bool:
        return time.monotonic() < self.end and (self.count is None or self.sent < self.count)


def _at_patient(bench: Bench) -> tuple[_Round, bool, int | None]:
    """Each call begins anew. Then whether an honest surgeon comes in, and the exit code."""
    settings = learn_settings(bench)
    patient = bench.patient()
    mutator = Mutator(bench.seed)
    told = _Round(bench)
    while told.goes_on() and patient.running:
        with Surgeon(bench.identity("surgeon"), patient.address(), settings) as site:
            edit_hellos(site, mutator)
            site.on_tick = lambda now: ask_again(site)
            if site.run(0.5, lambda: site.established):
                site.on_tick = lambda now: _offer_again(site)  # Within a session as well.
                site.run(0.3)
            told.sent += site.counts["edited"]
    with Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        honest = surgeon.run(10, lambda: surgeon.established)
    return told, honest, patient.finish()


def _at_surgeon(bench: Bench) -> tuple[_Round, bool, set[int | None]]:
    """Each surgeon hears some thousand; then whether one gets an honest patient."""
    mutator = Mutator(bench.seed)
    told = _Round(bench)
    codes = set()
    while told.goes_on():
        with Patient(bench.identity("patient")) as site:
            program = bench.surgeon(site.address, "--master", bench.script("hold 600"))
            edit_hellos(site, mutator)
            site.on_tick = lambda now: _offer_again(site)
            site.run(3, lambda: not program.running)
            told.sent += site.counts["edited"]
        codes.add(program.finish())
    with Patient(bench.identity("patient")) as site:
        program = bench.surgeon(site.address, "--master", bench.script("hold 600"))
        honest = site.run(10, lambda: site.established)
        codes.add(program.finish())
    return told, honest, codes


def hellos(bench: Bench) -> Verdict:
    """A peer whose Hello is wrong is refused; then an honest one comes in, at both sites."""
    at_patient, honest_surgeon, code = _at_patient(bench)
    at_surgeon, honest_patient, codes = _at_surgeon(bench)
    codes.add(code)
    least = bench.count or 1
    return Verdict(
        f"{at_patient.sent} edited hellos at the patient, {at_surgeon.sent} at the surgeon; then "
        f"an honest surgeon {'came in' if honest_surgeon else 'did not come in'}, an honest "
        f"patient {'was taken' if honest_patient else 'was not taken'}; "
        f"exit codes {sorted(map(str, codes))}",
        honest_surgeon and honest_patient and codes <= {0, 3, 4}
        and min(at_patient.sent, at_surgeon.sent) >= least,
    )  # fmt: skip


def ask_again(site: Surgeon) -> None:
    if site.session is None and site.keys:
        for _ in range(3):
            site.send_hello(site.keys, site.peer)


def _offer_again(site: Site) -> None:
    if site.keys and site.peer:
        for _ in range(3):
            site.send_hello(site.keys, site.peer)


ATTACKS = [
    Attack("mutations-patient", "authenticated mutations, at palp-patient", of_patient, 8, 60),
    Attack("mutations-surgeon", "authenticated mutations, at palp-surgeon", of_surgeon, 8, 60),
    Attack("mutations-hello", "authenticated mutations of Hellos, at both", hellos),
]
