"""Files from elsewhere: a session file that unfolds without end, names that command a terminal,
tables that a spreadsheet of another country wrote.

Must hold: palp-review needs no more memory and time than the file's size explains, and prints
nothing that a terminal obeys; a table that is no table is refused in one sentence, not misread.
"""

from __future__ import annotations

import os
import re
import resource
import struct
import subprocess
import time
from pathlib import Path

from client.attack import Attack, Verdict
from client.programs import Bench
from client.session_file import CHANNEL, CHUNK, MAGIC, MESSAGE, SCHEMA

HEADER, FOOTER, ATTACHMENT, METADATA, DATA_END = 1, 2, 9, 12, 15
MEMORY_MAX_MB = 700
SECONDS_MAX = 10.0
ESCAPE = "\x1b[2J\x1b]0;gotcha\x07\x9b31m"
VERBS = ("info", "check", "recover", "metrics")


def _record(kind: int, body: bytes) -> bytes:
    return struct.pack("<BQ", kind, len(body)) + body


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<I", len(data)) + data


def _map(values: dict[str, str]) -> bytes:
    body = b"".join(_text(k) + _text(v) for k, v in values.items())
    return struct.pack("<I", len(body)) + body


def _file(*records: bytes) -> bytes:
    return MAGIC + b"".join(records) + _record(FOOTER, bytes(20)) + MAGIC


def _zstd_of_zeros(size: int) -> bytes:
    """A frame of blocks that each say: 128 KiB of one byte."""
    block = 128 * 1024
    frame = bytearray(b"\x28\xb5\x2f\xfd\xe0" + struct.pack("<Q", size))
    blocks = size // block
    for i in range(blocks):
        word = block << 3 | 1 << 1 | (i == blocks - 1)
        frame += struct.pack("<I", word)[:3] + b"\0"
    return bytes(frame)


def _bomb(said: int, real: int) -> bytes:
    """A chunk that says it holds `said` bytes and unfolds to `real`."""
    packed = _zstd_of_zeros(real)
    head = struct.pack("<QQQI", 0, 1, said, 0) + _text("zstd")
    chunk = _record(CHUNK, head + struct.pack("<Q", len(packed)) + packed)
    return _file(_record(HEADER, _text("") + _text("")), chunk, _record(DATA_END, bytes(4)))


def _many_bombs(count: int, each: int) -> bytes:
    packed = _zstd_of_zeros(each)
    head = struct.pack("<QQQI", 0, 1, each, 0) + _text("zstd")
    chunk = _record(CHUNK, head + struct.pack("<Q", len(packed)) + packed)
    return _file(_record(HEADER, _text("") + _text("")), chunk * count, _record(DATA_END, bytes(4)))


def _colourful() -> bytes:
    """Escape sequences wherever a name may stand."""
    x = ESCAPE
    schema = _record(SCHEMA, struct.pack("<H", 1) + _text(f"palp.{x}") + _text("protobuf" + x) + (
        struct.pack("<I", 0)
    ))
    channel = _record(CHANNEL, struct.pack("<HH", 1, 1) + _text(f"surgeon/{x}") + _text(x) + (
        _map({x: x})
    ))
    message = _record(MESSAGE, struct.pack("<HIQQ", 1, 0, 1, 1))
    metadata = [
        _record(METADATA, _text(name) + _map({
            "site": "surgeon" + x, "program": x, "version": x, "git_commit": x, "coupling": x,
            "host_kernel": x, "master": x, "hand": x, "grip": x, x: x,
        })) for name in ("palp", "palp.session", "session", x)
    ]  # fmt: skip
    attached = struct.pack("<QQ", 0, 0) + _text(x) + _text(x) + struct.pack("<Q", 0)
    return _file(
        _record(HEADER, _text("palp" + x) + _text(x)), schema, channel, message, *metadata,
        _record(ATTACHMENT, attached + bytes(4)), _record(DATA_END, bytes(4)),
    )  # fmt: skip


def _limits() -> None:
    """An address space that a broken reader cannot harm this machine with."""
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))


def _read(bench: Bench, path: Path, verb: str) -> tuple[int | None, str, float, float]:
    """Exit code (None: killed in the end), output, MB at most, seconds."""
    arguments = {
        "recover": [str(path), str(bench.work / "recovered.mcap")],
        "metrics": ["--surgeon", str(path), "--patient", str(path)],
    }.get(verb, [str(path)])
    sanitized = bench.sanitized
    began = time.monotonic()
    with (bench.work / "said").open("w+b") as said:
        process = subprocess.Popen(
            [bench.bin / "palp-review", verb, *arguments], stdout=said, stderr=said,
            preexec_fn=None if sanitized else _limits,
        )  # fmt: skip
        end = began + 3 * SECONDS_MAX
        pid = 0
        while pid == 0 and time.monotonic() < end:
            pid, status, usage = os.wait4(process.pid, os.WNOHANG)
            time.sleep(0.005)
        if pid == 0:
            process.kill()
            pid, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        text = said.read().decode("utf-8", errors="replace")
    return process.returncode, text, usage.ru_maxrss / 1024, time.monotonic() - began


def bombs(bench: Bench) -> Verdict:
    files = {
        "one chunk, 30 GB": _bomb(30 << 30, 30 << 30),
        "says 1 kB, 8 GB": _bomb(1024, 8 << 30),
        "2,000 chunks of 16 MB": _many_bombs(2000, 16 << 20),
    }
    wrong: list[str] = []
    memory_max = time_max = 0.0
    for name, data in files.items():
        path = bench.work / "bomb.mcap"
        path.write_bytes(data)
        for verb in VERBS:
            code, _, memory, seconds = _read(bench, path, verb)
            memory_max, time_max = max(memory_max, memory), max(time_max, seconds)
            if code is None or code < 0 or memory > MEMORY_MAX_MB or seconds > SECONDS_MAX:
                wrong.append(f"{verb} of '{name}': {memory:.0f} MB, {seconds:.1f} s, code {code}")
                break
        written = bench.work / "recovered.mcap"
        if written.exists():
            if written.stat().st_size > 100 * len(data):
                wrong.append(f"recover wrote {written.stat().st_size >> 20} MB")
            written.unlink()
    return Verdict(
        ", ".join(wrong) or f"{memory_max:.0f} MB and {time_max:.1f} s at most", not wrong
    )


def escapes(bench: Bench) -> Verdict:
    commands = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f]")
    wrong = set()
    path = bench.work / "colours.mcap"
    path.write_bytes(_colourful())
    for verb in VERBS:
        code, text, _, _ = _read(bench, path, verb)
        if commands.search(text):
            wrong.add(f"{verb} prints what a terminal obeys")
        if code is None or code < 0:
            wrong.add(f"{verb} ended by {code}")
    return Verdict(", ".join(sorted(wrong)) or "plain text", not wrong)


GOOD = "d_mm,F_N\n0,0\n1,0.1\n2,0.25\n3,0.5\n4,0.8\n5,1.2\n"
TABLES = {
    "a byte order mark": "\ufeff" + GOOD,
    "decimal commas": "d_mm,F_N\n0,0\n1,0,1\n2,0,25\n3,0,5\n4,0,8\n",
    "decimal commas in quotes": 'd_mm,F_N\n"0","0"\n"1,0","0,1"\n"2,0","0,25"\n"3,0","0,5"\n',
    "decimal commas, semicolons": "d_mm;F_N\n0;0\n1,0;0,1\n2,0;0,25\n3,0;0,5\n",
    "words behind numbers": "d_mm,F_N\n0,0\n1,0.1N\n2,0.25N\n3,0.5N\n",
    "a falling force": "d_mm,F_N\n0,0\n1,0.8\n2,0.5\n3,0.2\n4,0.1\n",
    "falling depths": "d_mm,F_N\n4,0.8\n3,0.5\n2,0.25\n1,0.1\n0,0\n",
    "a force that is no number": "d_mm,F_N\n0,0\n1,nan\n2,0.25\n3,0.5\n",
    "a force without end": "d_mm,F_N\n0,0\n1,0.1\n2,inf\n3,inf\n",
    "a pulling force": "d_mm,F_N\n0,0\n1,-5\n2,-10\n3,-20\n",
    "hexadecimal": "d_mm,F_N\n0,0\n0x1,0x1\n0x2,0x2\n0x3,0x3\n",
}
ACCEPTABLE = {"a byte order mark"}  # Reading it as a table is as good as a clear refusal.


GOOD_HAND = "t_s,position_mm\n0,-10\n1,-5\n2,2\n3,-10\n"
HANDS = {
    "decimal commas": "t_s,position_mm\n0,-10\n0,5,-5\n1,0,2,5\n",
    "times that fall": "t_s,position_mm\n3,-10\n2,-5\n1,2\n0,-10\n",
    "a position that is no number": "t_s,position_mm\n0,-10\n1,nan\n2,2\n",
}


def _judge(bench: Bench, name: str, text: str, hand: bool) -> str:
    """What is wrong about how a program took the table; nothing: all is well."""
    path = bench.work / "table.csv"
    path.write_text(text, encoding="utf-8")
    site = (
        ("palp-surgeon", "--peer", "127.0.0.1:9", "--master", f"replay:{path}")
        if hand
        else ("palp-patient", "--listen", "127.0.0.1:0", "--phantom", f"file:{path}")
    )
    command = [bench.bin / site[0], *site[1:], "--insecure", "--duration-s", "0.1"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=20, check=False)
    refused = run.returncode == 2 and str(path) in run.stderr
    if name == "good":
        return f"a good one refused: {run.stderr.strip()[:80]}" if refused else ""
    if not refused and name not in ACCEPTABLE:
        return f"{name}: " + ("accepted" if run.returncode in (0, 4) else f"{run.stderr.strip()}")
    return "" if run.stderr.isascii() else f"{name}: {run.stderr.strip()[:100]!a}"


def tables(bench: Bench) -> Verdict:
    wrong = [_judge(bench, *table, hand=False) for table in [("good", GOOD), *TABLES.items()]]
    wrong += [_judge(bench, *table, hand=True) for table in [("good", GOOD_HAND), *HANDS.items()]]
    wrong = [what for what in wrong if what]
    return Verdict(
        f"{len(TABLES) + len(HANDS)} broken tables: " + ("; ".join(wrong) or "all refused"),
        not wrong,
    )


ATTACKS = [
    Attack("review-bomb", "session files that unfold without end", bombs),
    Attack("review-escapes", "names that command a terminal", escapes),
    Attack("csv", "tables with decimal commas, falling curves, byte order marks", tables),
]
