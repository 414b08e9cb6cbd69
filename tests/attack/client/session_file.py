"""A session file (MCAP), read for what a hand was given: docs/log-files.md, session_log.proto."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import zstandard

from client.schema import LOG_MESSAGES, decode
from client.session import ENGAGED, HOLD

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK = 3, 4, 5, 6


def _records(data: bytes, at: int = 0) -> Iterator[tuple[int, bytes]]:
    while at + 9 <= len(data):
        kind, size = struct.unpack_from("<BQ", data, at)
        if at + 9 + size > len(data):
            return
        yield kind, data[at + 9 : at + 9 + size]
        at += 9 + size


def _text(data: bytes, at: int) -> tuple[str, int]:
    (size,) = struct.unpack_from("<I", data, at)
    return data[at + 4 : at + 4 + size].decode(), at + 4 + size


def _unfolded(path: Path) -> Iterator[tuple[int, bytes]]:
    for kind, body in _records(path.read_bytes(), len(MAGIC)):
        if kind != CHUNK:
            yield kind, body
            continue
        compression, at = _text(body, 28)
        (size,) = struct.unpack_from("<Q", body, at)
        packed = body[at + 8 : at + 8 + size]
        if compression:
            packed = zstandard.ZstdDecompressor().decompressobj().decompress(packed)
        yield from _records(packed)


def messages(path: Path, topic: str) -> Iterator[tuple[int, dict]]:
    """Instants [ns] and messages of a topic; a file that was cut short as far as it goes."""
    schemas: dict[int, str] = {}
    wanted: dict[int, str] = {}
    for kind, body in _unfolded(path):
        if kind == SCHEMA:
            schemas[struct.unpack_from("<H", body)[0]] = _text(body, 2)[0].split(".")[-1]
        elif kind == CHANNEL:
            channel, schema = struct.unpack_from("<HH", body)
            if _text(body, 4)[0] == topic:
                wanted[channel] = schemas[schema]
        elif kind == MESSAGE:
            channel, _, _, published = struct.unpack_from("<HIQQ", body)
            if channel in wanted:
                yield published, decode(wanted[channel], body[22:], LOG_MESSAGES)


def instants(path: Path, topic: str) -> Iterator[int]:
    """Instants [ns] of a topic's messages, which stay folded."""
    wanted: set[int] = set()
    for kind, body in _unfolded(path):
        if kind == CHANNEL and _text(body, 4)[0] == topic:
            wanted.add(struct.unpack_from("<H", body)[0])
        elif kind == MESSAGE and struct.unpack_from("<H", body)[0] in wanted:
            yield struct.unpack_from("<HIQQ", body)[3]


@dataclass
class HandTold:
    """What the surgeon's hand felt in a session."""

    ticks: int = 0
    engaged: int = 0
    force_max: float = 0.0  # [N]
    force_step: float = 0.0  # [N], the largest change in 10 ms
    energy_gained: float = 0.0  # [J], the most that the hand had gained since the start

    def __str__(self) -> str:
        return (
            f"{self.energy_gained * 1e3:.2f} mJ into the hand, {self.force_max:.2f} N at most, "
            f"{self.force_step:.2f} N in 10 ms, {self.engaged} ticks engaged"
        )


def hand_of(path: Path) -> HandTold:
    """The force of a tick is what the hand had since the tick before."""
    told = HandTold()
    energy = last = None
    recent: list[tuple[int, float]] = []
    for at, tick in messages(path, "surgeon/tick"):
        told.ticks += 1
        told.engaged += tick["state"] in (ENGAGED, HOLD)
        position, force = tick["position_m"], tick["force_n"]
        energy = 0.0 if energy is None else energy - force * (position - last)
        last = position
        told.energy_gained = max(told.energy_gained, energy)
        told.force_max = max(told.force_max, abs(force))
        recent = [(t, f) for t, f in recent if at - t <= 10_000_000] + [(at, force)]
        told.force_step = max(told.force_step, max(abs(force - f) for _, f in recent))
    return told
