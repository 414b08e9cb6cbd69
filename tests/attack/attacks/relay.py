"""Strangers at the relay: another user of the machine, a web page, a datagram of one byte.

They can: reach its TCP control from any user and, by a form's POST, from any page that a browser
shows; name files to write and to read; send to the port where the surgeon sends.
Must hold: without the owner's rights nothing is obeyed; the owner too names no path outside the
relay's folder; what comes back goes to who is served, not to who sent last.
"""

from __future__ import annotations

import itertools
import json
import os
import socket
import subprocess
import sys
import time
from pathlib import Path

from client.attack import Attack, Skipped, Verdict
from client.programs import Bench, Program, wait_for

NOBODY = 65534
# Connects to argv[1] (a port, or a path), sends argv[2], prints what comes.
TALK = """
import socket, sys
where = sys.argv[1]
try:
    if where.isdigit():
        s = socket.create_connection(("127.0.0.1", int(where)), 2)
    else:
        s = socket.socket(socket.AF_UNIX)
        s.connect(where)
    s.settimeout(1)
    s.sendall(sys.argv[2].encode())
    print(s.recv(4096).decode(errors="replace"))
except OSError as error:
    print("refused:", error)
"""


def _say(where: str | int, line: str, as_nobody: bool) -> str:
    user = {"user": NOBODY, "group": NOBODY, "extra_groups": []}
    run = subprocess.run(
        [sys.executable, "-c", TALK, str(where), line],
        capture_output=True, text=True, cwd="/", check=False,
        **(user if as_nobody and os.getuid() == 0 else {}),
    )  # fmt: skip
    return run.stdout.strip()


def _relay(bench: Bench, *arguments: object, forward: str = "127.0.0.1:9") -> Program:
    return bench.start(
        "palp-netem", "relay", "--listen", "127.0.0.1:0", "--forward", forward, *arguments,
        cwd=bench.work,
    )  # fmt: skip


def _control_port(relay: Program) -> int | None:
    """None: the relay has no TCP control, or does not start with one."""
    wait_for(lambda: "forwarding to" in relay.log or not relay.running, 10)
    for line in relay.log.splitlines():
        if line.startswith("control on 127.0.0.1:"):
            return int(line.split(":")[1].split()[0])
    return None


def _forged_post(line: str) -> str:
    return (
        "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://example.org\r\n"
        f"Content-Type: text/plain\r\nContent-Length: {len(line) + 1}\r\n\r\n{line}\n"
    )


def relay_tcp(bench: Bench) -> Verdict:
    """What another user and a web page do by TCP."""
    victim = bench.work / "of-the-owner-up.csv"
    victim.write_text("precious\n")
    record = json.dumps({"record": str(victim).removesuffix("-up.csv")})
    obeyed: list[str] = []
    # Without a token, and as one who does not know it; a relay that refuses to start has held.
    kinds = ([], ["--control-token", bench.work / "token"])
    attempts = [
        ("record", record + "\n"),
        ("set", '{"set":"delay 500ms"}\n'),
        ("quit", '{"quit":true}\n'),
        ("post-set", _forged_post('{"set":"delay 500ms"}')),
        ("post-quit", _forged_post('{"quit":true}')),
    ]
    for (name, words), kind in itertools.product(attempts, kinds):
        relay = _relay(bench, "--control", "127.0.0.1:0", *kind)
        port = _control_port(relay)
        if port is None:
            continue
        answer = _say(port, words, as_nobody=True)
        wait_for(lambda: not relay.running, 0.5)
        if "applied" in answer or not relay.running or victim.read_text() != "precious\n":
            obeyed.append(name)
        victim.write_text("precious\n")
        relay.finish()
    return Verdict(f"by TCP obeyed without a token: {', '.join(obeyed) or 'nothing'}", not obeyed)


def relay_unix(bench: Bench) -> Verdict:
    """What another user does by a Unix socket, and whom the owner can harm by a path."""
    if os.getuid() != 0:
        raise Skipped("needs root, to be another user")
    os.chmod(bench.work, 0o755)
    path = bench.work / "control"
    relay = _relay(bench, "--control", f"unix:{path}", "--timeline", _empty_timeline(bench))
    wait_for(lambda: path.exists() or not relay.running, 10)
    stranger = _say(str(path), '{"stats":true}\n', as_nobody=True)
    wrong: list[str] = [] if stranger.startswith("refused") else ["another user is heard"]
    outside = bench.work.parent / f"{bench.work.name}-outside"
    for name in (str(outside), f"../{outside.name}"):
        _say(str(path), json.dumps({"record": name}) + "\n", as_nobody=False)
        if list(outside.parent.glob(f"{outside.name}*")):
            wrong.append(f"record wrote to {name.replace(str(outside.parent), '/...')}")
        _say(str(path), '{"record":""}\n', as_nobody=False)
        for file in outside.parent.glob(f"{outside.name}*"):
            file.unlink()
    outside.write_text("t_ms,delay_ms\n0,1\n1000,1\n")
    for name in (str(outside), f"../{outside.name}", "/proc/self/environ"):
        answer = _say(str(path), json.dumps({"dir": "UP", "trace": {"file": name}}) + "\n", False)
        if "applied" in answer or "expected" in answer:
            wrong.append(f"trace read {name.replace(str(outside.parent), '/...')}")
    outside.unlink()
    relay.finish(3)
    return Verdict(f"by a Unix socket: {', '.join(wrong) or 'only the owner, only below'}",
                   not wrong)  # fmt: skip


def _empty_timeline(bench: Bench) -> Path:
    path = bench.work / "timeline"
    path.write_text("mode: EXACT\n")
    return path


def relay_way_back(bench: Bench) -> Verdict:
    """A client at 500/s, an echoing server behind the relay, strangers of one byte each."""
    udp = (socket.AF_INET, socket.SOCK_DGRAM)
    with socket.socket(*udp) as server, socket.socket(*udp) as client:
        server.bind(("127.0.0.1", 0))
        for one in (server, client):
            one.setblocking(False)
        relay = _relay(bench, forward=f"127.0.0.1:{server.getsockname()[1]}")
        peer = relay.address()
        sent = came = diverted = 0
        strangers = [socket.socket(*udp) for _ in range(8)]
        for i, stranger in enumerate(strangers):
            stranger.bind((f"127.0.2.{i + 1}", 0))
            stranger.setblocking(False)
        for tick in range(int(bench.seconds * 500)):
            client.sendto(b"\x80" + bytes(100), peer)
            sent += 1
            if tick > 250 and tick % 2 == 0:
                strangers[tick // 2 % 8].sendto(b"x", peer)
            came += _drain(client)
            for datagram, source in _received(server):
                if len(datagram) > 1:
                    server.sendto(datagram, source)
            diverted += sum(_drain(s) for s in strangers)
            time.sleep(0.002)
        came += _drain(client)
        for stranger in strangers:
            stranger.close()
    return Verdict(
        f"of {sent} datagrams {came} came back to the client, {diverted} went to strangers",
        diverted == 0 and came >= 0.98 * sent,
    )


def _received(one: socket.socket) -> list[tuple[bytes, tuple[str, int]]]:
    got = []
    while True:
        try:
            got.append(one.recvfrom(65535))
        except OSError:
            return got


def _drain(one: socket.socket) -> int:
    return len(_received(one))


ATTACKS = [
    Attack("relay-tcp", "another user, or a web page, at the relay's TCP control", relay_tcp),
    Attack("relay-unix", "another user at its Unix socket; paths outside its folder", relay_unix),
    Attack("relay-way-back", "one-byte datagrams that divert what comes back", relay_way_back, 4),
]
