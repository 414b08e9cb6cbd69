"""Whoever can send to a site's port, without any key.

He can: send whatever he likes, in the peer's name too; repeat what he heard; change it.
Must hold: the program lives, the session goes on as if nothing came, memory does not grow.
"""

from __future__ import annotations

import random
import socket
import struct
from collections.abc import Callable, Iterator

from client import wire
from client.attack import Attack, Verdict, learn_settings
from client.dtls import Handshake
from client.programs import Bench, Program
from client.site import Patient, Site, Surgeon

STRANGERS = 16
PER_TICK = 40

Maker = Callable[[random.Random, "Ear"], bytes]


class Ear:
    """What an observer has: the newest datagrams of the session, and a hello."""

    def __init__(self) -> None:
        self.heard: list[bytes] = [wire.header(0, 0, 64, 1, 0) + bytes(64)]
        self.hello = b"".join(Handshake(True, None).take())

    def listen(self, datagram: bytes) -> None:
        self.heard.append(datagram)
        del self.heard[:-512]

    def newest(self) -> bytes:
        return self.heard[-1]


def _record(kind: int, body: bytes, version: int = 0xFEFD, epoch: int = 0, number: int = 0,
            size: int | None = None) -> bytes:  # fmt: skip
    told = len(body) if size is None else size
    head = struct.pack(">BHHHIH", kind, version, epoch, 0, number & 0xFFFFFFFF, told & 0xFFFF)
    return head + body


def _fragment(kind: int, body: bytes, total: int, offset: int, size: int, number: int = 0) -> bytes:
    def three(value: int) -> bytes:
        return (value & 0xFFFFFF).to_bytes(3, "big")

    head = bytes([kind]) + three(total) + struct.pack(">H", number) + three(offset) + three(size)
    return _record(22, head + body)


def _resized(r: random.Random, ear: Ear) -> bytes:
    told = bytearray(ear.newest())
    told[2:4] = r.randbytes(2)
    return bytes(told)


def _ahead(r: random.Random, ear: Ear) -> bytes:
    told = bytearray(ear.newest())
    told[8:16] = r.choice([r.getrandbits(53), 1 << 53, (1 << 53) + 1, (1 << 64) - 1]).to_bytes(
        8, "big"
    )
    return bytes(told)


def _bit_flipped(r: random.Random, data: bytes) -> bytes:
    told = bytearray(data)
    told[r.randrange(len(told))] ^= 1 << r.randrange(8)
    return bytes(told)


def _of_type(kind: int) -> Maker:
    return lambda r, ear: bytes([0x80 | kind]) + ear.newest()[1:]


KINDS: dict[str, Maker] = {
    "nothing": lambda r, ear: b"",
    "a byte": lambda r, ear: r.randbytes(1),
    "noise": lambda r, ear: r.randbytes(r.randrange(1, 1500)),
    "long noise": lambda r, ear: r.randbytes(r.choice([1201, 4096, 9000])),
    "our header, noise": lambda r, ear: ear.newest()[:16] + r.randbytes(r.randrange(200)),
    "a bare header": lambda r, ear: ear.newest()[:16],
    "a short header": lambda r, ear: ear.newest()[: r.randrange(16)],
    "a wrong length": _resized,
    "a number ahead": _ahead,
    "the newest again": lambda r, ear: ear.newest(),
    "an old one again": lambda r, ear: r.choice(ear.heard),
    "a bit flipped": lambda r, ear: _bit_flipped(r, ear.newest()),
    "cut short": lambda r, ear: ear.newest()[: r.randrange(len(ear.newest()))],
    "two in one": lambda r, ear: r.choice(ear.heard) + ear.newest(),
    "as control": _of_type(wire.CONTROL),
    "as path": _of_type(wire.PATH),
    "as close": _of_type(wire.CLOSE),
    "of no type": lambda r, ear: bytes([0x80 | r.randrange(4, 16)]) + ear.newest()[1:],
    "another key": lambda r, ear: ear.newest()[:1] + r.randbytes(1) + ear.newest()[2:],
    "another connection": lambda r, ear: ear.newest()[:4] + r.randbytes(4) + ear.newest()[8:],
    "ClientHello": lambda r, ear: ear.hello[:27] + r.randbytes(32) + ear.hello[59:],
    "ClientHello edited": lambda r, ear: _bit_flipped(r, ear.hello),
    "ClientHello cut": lambda r, ear: ear.hello[: r.randrange(13, len(ear.hello))],
    "ClientHello in pieces": lambda r, ear: _fragment(
        1, r.randbytes(20), 200, r.randrange(200), 20
    ),
    "a fragment without end": lambda r, ear: _fragment(
        r.choice([1, 2, 11, 16]), r.randbytes(30), -1, r.randrange(1 << 24), 30, r.randrange(9)
    ),
    "a fragment longer than it is": lambda r, ear: _fragment(1, b"x", 100, 90, 0xFFFF),
    "a fatal alert": lambda r, ear: _record(21, bytes([2, r.randrange(256)])),
    "close notify": lambda r, ear: _record(21, b"\1\0", epoch=r.randrange(2)),
    "ChangeCipherSpec": lambda r, ear: _record(20, b"\1"),
    "application data": lambda r, ear: _record(
        23, r.randbytes(50), epoch=1, number=r.getrandbits(32)
    ),
    "a heartbeat": lambda r, ear: _record(24, b"\1\xff\xff" + r.randbytes(16)),
    "records without content": lambda r, ear: _record(22, b"") * 80,
    "a record longer than it is": lambda r, ear: _record(22, r.randbytes(20), size=0xFFFF),
    "DTLS 1.0": lambda r, ear: _record(22, ear.hello[13:], version=0xFEFF),
    "TLS": lambda r, ear: b"\x16\x03\x01\x02\x00" + r.randbytes(100),
    "HelloVerifyRequest": lambda r, ear: _fragment(3, b"\xfe\xff\x20" + r.randbytes(32), 35, 0, 35),
    "ServerHello": lambda r, ear: _fragment(2, b"\xfe\xfd" + r.randbytes(36), 38, 0, 38),
    "STUN": lambda r, ear: b"\0\1\0\0\x21\x12\xa4\x42" + r.randbytes(12),
    "QUIC": lambda r, ear: b"\xc0\0\0\0\1\x08" + r.randbytes(1194),
    "DNS": lambda r, ear: r.randbytes(2) + b"\1\0\0\1\0\0\0\0\0\0\3www\0\0\1\0\1",
}


def junk(r: random.Random, ear: Ear) -> Iterator[bytes]:
    while True:
        for make in KINDS.values():
            yield make(r, ear)


def _attack(bench: Bench, site: Site, program: Program, strangers: list[socket.socket]) -> Verdict:
    ear = Ear()
    made = junk(random.Random(bench.seed), ear)
    seal = site.seal
    sent = 0

    def overheard(kind: int, message: bytes) -> bytes:
        datagram = seal(kind, message)
        ear.listen(datagram)
        return datagram

    def flood(now: float) -> None:
        nonlocal sent
        for i in range(PER_TICK):
            # Every second one in the peer's own name.
            site.send(next(made), via=strangers[sent // 2 % len(strangers)] if i % 2 else None)
            sent += 1

    site.seal = overheard
    site.run(15, lambda: site.established)
    site.run(1)
    memory, site.on_tick = program.resident_kb(), flood
    site.longest_pause = 0.0
    before = program.count("-> HOLD")
    site.run(bench.seconds, lambda: bench.count is not None and sent >= bench.count)
    site.on_tick = lambda now: None
    told = site.counts["telegrams"]
    site.run(0.5)
    spoke = site.counts["telegrams"] - told
    holds = program.count("-> HOLD") - before
    grown = program.resident_kb() - memory if program.running else 0
    sessions = site.counts["sessions"]
    own = site.longest_pause * 1e3
    code = program.finish()
    taken, honest = program.report.get("accepted", 0), site.counts["telegrams sent"]
    return Verdict(
        f"{sent} datagrams of {len(KINDS)} kinds, {spoke} telegrams in the last 0.5 s, "
        f"{taken} of {honest} honest telegrams taken, {sessions} session, {holds} holds "
        f"(own longest pause {own:.0f} ms), memory {grown:+d} kB, exit code {code}",
        spoke > 250 and sessions == 1 and (holds == 0 or own > 80) and bench.memory_is_kept(grown)
        and code in (0, 4) and 0.9 * honest < taken <= honest,
    )  # fmt: skip


def _strangers() -> list[socket.socket]:
    out = []
    for i in range(STRANGERS):
        one = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        one.bind((f"127.0.4.{i + 1}", 0))
        one.setblocking(False)
        out.append(one)
    return out


def of_patient(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    patient = bench.patient()
    with Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        surgeon.pedal = True
        return _attack(bench, surgeon, patient, _strangers())


def of_surgeon(bench: Bench) -> Verdict:
    """The surgeon's port is known to who sees its telegrams."""
    with Patient(bench.identity("patient")) as patient:
        surgeon = bench.surgeon(patient.address, "--master", bench.script("hold 600"))
        return _attack(bench, patient, surgeon, _strangers())


ATTACKS = [
    Attack("hostile-patient", "junk of 40 kinds without keys, at palp-patient", of_patient, 8, 60),
    Attack("hostile-surgeon", "junk of 40 kinds without keys, at palp-surgeon", of_surgeon, 8, 60),
]
