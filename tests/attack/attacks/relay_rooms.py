"""A thief at palp-relay: joins that are forged, copied or half honest, and junk, 100,000 a second.

They can: see every datagram of a room, send to the relay from hosts of their own, receive there,
and send copies from an address where a member once was.
Must hold: nobody is moved, and each member gets only what the other sent; the thief gets nothing
but answers to its own questions, none longer than its question; the relay's memory does not grow.
"""

from __future__ import annotations

import hashlib
import os
import random
import select
import socket
import time
from multiprocessing import Event, Process, Value

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

from client.attack import Attack, Verdict
from client.programs import Address, Bench

SIZE = 124  # of every message between a site and the relay [bytes]
ASK, COOKIE, JOIN, JOINED = 0, 1, 2, 3
SURGEON, PATIENT = 0, 1
PER_S = 100_000
MEMBER_PER_S = 200
NAME = "K7Q2-a-name-that-nobody-guesses"


def _message(kind: int, role: int, room: bytes, cookie: bytes, proof: bytes) -> bytes:
    return bytes([0x84, kind, role, 0]) + room + cookie + proof


class Member:
    """A site's half of the talk with the relay, and numbered telegrams through it."""

    def __init__(self, role: int, relay: Address) -> None:
        self.key = Ed25519PrivateKey.from_private_bytes(
            hashlib.sha256(b"palp relay room 1: " + NAME.encode()).digest()
        )
        self.room = self.key.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw)
        self.role, self.relay = role, relay
        self.sent, self.got, self.foreign = 0, 0, 0
        self.join = b""
        self.enter("127.0.0.1")

    def enter(self, host: str) -> None:
        """From a new address; where it was before stays open, for the thief."""
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind((host, 0))
        for _ in range(100):
            answer = self._say(_message(ASK, self.role, self.room, bytes(24), os.urandom(64)))
            if answer[1:2] != bytes([COOKIE]):
                continue
            claim = _message(JOIN, self.role, self.room, answer[36:60], b"")
            self.join = claim + self.key.sign(claim)
            if self._say(self.join)[1:2] == bytes([JOINED]):
                return
        raise RuntimeError("the relay lets nobody in")

    def _say(self, message: bytes) -> bytes:
        self.socket.sendto(message, self.relay)
        if not select.select([self.socket], [], [], 0.5)[0]:
            return b""
        return self.socket.recv(2048)

    def send(self) -> None:
        self.sent += 1
        self.socket.sendto(b"\x80" + bytes([self.role]) + bytes(120), self.relay)

    def take(self) -> None:
        while select.select([self.socket], [], [], 0)[0]:
            datagram = self.socket.recv(2048)
            if datagram[0] == 0x84:
                continue
            honest = datagram == b"\x80" + bytes([1 - self.role]) + bytes(120)
            self.got += honest
            self.foreign += not honest


def _own_cookie(thief: socket.socket, room: bytes, role: int, relay: Address) -> bytes:
    thief.sendto(_message(ASK, role, room, bytes(24), os.urandom(64)), relay)
    return thief.recv(2048)[36:60] if select.select([thief], [], [], 1)[0] else bytes(24)


def _flood(host, relay, joins, old, stop, told) -> None:
    """`joins`: as heard on the wire; `old`: sockets where members were, and their joins there.
    `told`: datagrams sent, bytes sent, bytes got, telegrams got."""
    chance = random.Random(host)
    thief = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    thief.bind((host, 0))
    thief.setblocking(False)
    began, sent, cookie_at, half = time.monotonic(), 0, 0.0, b""
    while not stop.is_set():
        now = time.monotonic()
        if now - cookie_at > 5:
            cookie_at, heard = now, joins[sent % len(joins)]
            own = _own_cookie(thief, heard[4:36], heard[2], relay)
            told[1].value += SIZE
            told[2].value += SIZE
            half = heard[:36] + own + heard[60:]  # a good cookie, another's proof
        heard = joins[sent % len(joins)]
        junk = chance.randbytes(SIZE)
        for datagram in (
            heard,  # a copy, from elsewhere
            heard[:36] + junk[36:],  # forged whole
            half,
            heard[:1] + junk[1:],  # looks like a message
            b"\x80" + junk[1:],  # looks like a telegram
            b"\x16" + junk[1:],  # looks like a handshake
            heard[:1] + b"\0" + heard[2:],  # a question
            junk[:1],
        ):
            try:
                thief.sendto(datagram, relay)
                told[1].value += len(datagram)
                sent += 1
            except OSError:
                pass
        for once, join in old:
            once.sendto(join, relay)  # a copy, from where it was good
            sent += 1
        try:
            while True:
                answer = thief.recv(2048)
                told[2].value += len(answer)
                told[3].value += answer[:1] != b"\x84"
        except OSError:
            pass
        told[0].value = sent
        ahead = sent / (PER_S / 2) - (time.monotonic() - began)
        if ahead > 0.002:
            time.sleep(ahead)


def _exchange(members: list[Member], seconds: float) -> None:
    began, rounds = time.monotonic(), 0
    while (now := time.monotonic()) - began < seconds:
        while rounds < (now - began) * MEMBER_PER_S:
            rounds += 1
            for member in members:
                member.send()
        for member in members:
            member.take()
        time.sleep(0.001)


def relay_rooms(bench: Bench) -> Verdict:
    relay = bench.start("palp-relay", "--listen", "127.0.0.1:0")
    address = relay.address()
    members = [Member(SURGEON, address), Member(PATIENT, address)]
    old = []
    for member in members:  # each has moved once
        old.append((member.socket, member.join))
        member.enter("127.0.0.1")
    joins = [member.join for member in members] + [join for _, join in old]
    _exchange(members, 0.5)
    before = relay.resident_kb()

    stop = Event()
    told = [[Value(kind, 0, lock=False) for kind in "QQQQ"] for _ in range(2)]
    thieves = [
        Process(target=_flood, args=(f"127.0.66.{i + 1}", address, joins, old, stop, told[i]))
        for i in range(2)
    ]
    began = time.monotonic()
    for thief in thieves:
        thief.start()
    _exchange(members, bench.seconds)
    stop.set()
    for thief in thieves:
        thief.join()
    rate = sum(one[0].value for one in told) / (time.monotonic() - began)
    grown = relay.resident_kb() - before
    during = sum(member.got for member in members) / sum(member.sent for member in members)

    # What is still on its way is taken before the last word: both are where they were.
    _exchange(members, 0.5)
    for member in members:
        member.sent = member.got = 0
    _exchange(members, 1)
    time.sleep(0.1)
    wrong: list[str] = []
    for member in members:
        member.take()
        if member.got < 0.9 * member.sent:
            wrong.append(f"{member.got} of {member.sent} come through afterwards")
        if member.foreign:
            wrong.append(f"{member.foreign} that the other did not send")
    for once, _ in old:
        while select.select([once], [], [], 0)[0]:
            if once.recv(2048)[0] != 0x84:
                wrong.append("a copy of a join brought a member back")
                break
    sent_bytes, got_bytes, telegrams = (sum(one[i].value for one in told) for i in (1, 2, 3))
    if telegrams:
        wrong.append(f"the thief got {telegrams} telegrams")
    if got_bytes > sent_bytes:
        wrong.append(f"{got_bytes} bytes answered to {sent_bytes}")
    if not bench.memory_is_kept(grown):
        wrong.append(f"{grown} kB more memory")
    return Verdict(
        f"{rate:,.0f} datagrams/s: {', '.join(wrong) or 'nobody moved'}; {100 * during:.0f} % of "
        f"the members' came through meanwhile, {grown} kB more memory",
        not wrong,
    )


ATTACKS = [
    Attack("relay-rooms", "forged, copied and half honest joins, and junk, at palp-relay",
           relay_rooms, seconds=5)
]  # fmt: skip
