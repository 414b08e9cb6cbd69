"""Another user of the machine opens a second socket on the patient's port.

He can: ask for the port with SO_REUSEADDR and SO_REUSEPORT all the time, while surgeons come.
Must hold: he never gets it, and the next surgeon comes in.
"""

from __future__ import annotations

import os
import subprocess
import sys

from client.attack import Attack, Verdict, learn_settings
from client.programs import Bench, wait_for
from client.session import Settings
from client.site import Surgeon

THIEF = """
import socket, sys, time
port, got, kept = int(sys.argv[1]), 0, []
print("ready", flush=True)
while True:
    for host in ("127.0.0.1", "0.0.0.0", "127.0.0.1"):
        for options in ((2,), (2, 15)):
            s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            for option in options:
                s.setsockopt(socket.SOL_SOCKET, option, 1)
            try:
                s.bind((host, port))
            except OSError:
                s.close()
                continue
            kept.append(s)
            print("got", host, options, flush=True)
"""


def _one_session(bench: Bench, settings: Settings, peer: tuple[str, int]) -> bool:
    with Surgeon(bench.identity("surgeon"), peer, settings) as surgeon:
        came_in = surgeon.run(5, lambda: surgeon.established)
        surgeon.run(0.1)
    return came_in


def shared_port(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    patient = bench.patient()
    peer = patient.address()
    stranger = {"user": 65534, "group": 65534, "extra_groups": []} if os.getuid() == 0 else {}
    log = bench.work / "thief.log"
    command = [sys.executable, "-c", THIEF, str(peer[1])]
    thieves = [
        subprocess.Popen(command, stdout=log.open("a"), cwd="/", **stranger) for _ in range(2)
    ]
    tried = came_in = 0
    try:
        wait_for(lambda: "ready" in log.read_text(), 10)
        while tried == came_in and tried < 5 * bench.seconds:
            tried += 1
            came_in += _one_session(bench, settings, peer)
    finally:
        for thief in thieves:
            thief.kill()
            thief.wait()
    got = log.read_text().count("got")
    who = "another user" if stranger else "the same user"
    return Verdict(
        f"{came_in} of {tried} sessions began, {who} got the port {got} times",
        got == 0 and came_in == tried,
    )


ATTACKS = [
    Attack("shared-port", "another user's socket on the patient's port", shared_port, 16)
]
