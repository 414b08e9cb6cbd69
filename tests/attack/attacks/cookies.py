"""Strangers on many hosts show good cookies and never finish a handshake.

They can: receive at their addresses, so their cookies are good, and show each again and again in
hellos that differ: 1,000 a second from 40 hosts. Each begins a handshake that nobody ends.
Must hold: an honest surgeon is in session within 3 s of its start, each time.
"""

from __future__ import annotations

import os
import select
import socket
import time
from collections.abc import Callable

from client.attack import Attack, Verdict
from client.dtls import Handshake
from client.programs import Address, Bench

HOSTS = 40
HELLOS_PER_S = 1000
WITHIN_S = 3.0
RANDOM = slice(13 + 12 + 2, 13 + 12 + 2 + 32)  # of a ClientHello in its record
HELLO_VERIFY_REQUEST = 3


class Stranger:
    """One host, with a hello that bears its cookie."""

    def __init__(self, host: str, peer: Address) -> None:
        self.peer = peer
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind((host, 0))
        self.hello = bytearray(self._hello_with_cookie())

    def _hello_with_cookie(self) -> bytes:
        handshake = Handshake(True, None)
        for _ in range(20):
            for record in handshake.take():
                self.socket.sendto(record, self.peer)
            if not select.select([self.socket], [], [], 0.5)[0]:
                handshake.wait()
                continue
            answer = self.socket.recv(65535)
            if len(answer) > 13 and answer[13] == HELLO_VERIFY_REQUEST:
                handshake.feed(answer)
                return handshake.take()[0]
        raise RuntimeError("the patient gives no cookie")

    def show(self) -> None:
        self.hello[RANDOM] = os.urandom(32)
        try:
            self.socket.sendto(self.hello, self.peer)
        except OSError:
            pass  # What the patient answered was never read.


def _flood(strangers: list[Stranger], seconds: float, until: Callable[[], bool]) -> float:
    """@returns how long it took until `until`."""
    began = time.monotonic()
    shown = 0
    while (now := time.monotonic()) - began < seconds and not until():
        while shown < (now - began) * HELLOS_PER_S:
            strangers[shown % len(strangers)].show()
            shown += 1
        time.sleep(0.005)
    return time.monotonic() - began


def cookies(bench: Bench) -> Verdict:
    bench.make_keys("keys")
    patient = bench.patient()
    strangers = [Stranger(f"127.0.1.{i + 1}", patient.address()) for i in range(HOSTS)]
    took: list[float] = []
    end = time.monotonic() + bench.seconds
    while time.monotonic() < end:
        _flood(strangers, 1, lambda: False)
        surgeon = bench.surgeon(patient.address())
        took.append(_flood(strangers, 40, lambda: "session with" in surgeon.log))
        surgeon.finish()
    return Verdict(
        f"{HOSTS} hosts, {HELLOS_PER_S} hellos/s; {len(took)} surgeons were in session after "
        f"{min(took):.1f} to {max(took):.1f} s",
        max(took) <= WITHIN_S,
    )


ATTACKS = [
    Attack("cookies", "hosts that show cookies and never finish a handshake", cookies, seconds=15)
]
