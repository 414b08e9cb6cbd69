"""A peer with good keys seals datagrams longer than any telegram may be.

It can: send them from its own address or from a second one, of every type, up to what UDP carries.
Must hold: those of type data are refused as malformed before their content is looked at; the
session goes on. An overrun by some bytes shows in a build with sanitizers only.
"""

from __future__ import annotations

import socket

from client import wire
from client.attack import Attack, Verdict, learn_settings
from client.programs import Bench
from client.site import Surgeon

SIZES = [1199, 1200, 1201, 1202, 1215, 1216, 1217, 1400, 1472, 2048, 4096, 9000, 32768, 65507]
KINDS = [wire.DATA, wire.CONTROL, wire.PATH, wire.CLOSE]


def oversize(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    patient = bench.patient()
    elsewhere = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    elsewhere.bind(("127.0.0.2", 0))
    with elsewhere, Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        surgeon.run(10, lambda: surgeon.established)
        surgeon.run(0.5)
        plan = [(s, k, v) for s in SIZES for k in KINDS for v in (elsewhere, None)]
        sent = 0

        def lie(now: float) -> None:
            nonlocal sent
            if surgeon.session:
                size, kind, via = plan[sent % len(plan)]
                surgeon.send(surgeon.seal(kind, bytes(size - 32)), via=via)
                sent += 1

        surgeon.on_tick = lie
        surgeon.run(bench.seconds)
        surgeon.on_tick = lambda now: None
        before = surgeon.counts["telegrams"]
        surgeon.run(0.5)
        lives = surgeon.counts["telegrams"] - before > 100
        sessions = surgeon.counts["sessions"]
    code = patient.finish()
    too_long = sum(size > wire.DATAGRAM_BYTES_MAX for size in SIZES) / len(SIZES) * sent
    data_too_long = too_long / len(KINDS)
    refused = patient.report.get("rejected", {}).get("malformed", 0)
    return Verdict(
        f"{sent} sealed datagrams, about {too_long:.0f} of them above 1,200 bytes, {refused} "
        f"refused as malformed, {sessions} session, exit code {code}",
        lives and sessions == 1 and code == 0 and refused >= 0.95 * data_too_long,
    )


ATTACKS = [Attack("oversize", "sealed datagrams of 1,199 to 65,507 bytes", oversize)]
