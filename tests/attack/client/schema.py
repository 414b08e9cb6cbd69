"""Messages in protobuf's encoding, read and written from the .proto files of proto/ alone.

A message is a dict of names; enumerators are numbers. Two layers: `pack` and `unpack` know only
tags and wire types (a mutation edits there), `encode` and `decode` know the schema.
"""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from pathlib import Path

PROTO = Path(__file__).resolve().parents[3] / "proto"
VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5

# One field on the wire: its number, its wire type, what stands there.
Field = tuple[int, int, int | bytes]


@dataclass(frozen=True)
class Entry:
    """A field of a message in the schema."""

    number: int
    name: str
    kind: str  # a scalar of protobuf, "enum", or the name of a message
    optional: bool


_SCALARS = {
    "uint32": VARINT, "uint64": VARINT, "int64": VARINT, "bool": VARINT, "enum": VARINT,
    "fixed32": FIXED32, "float": FIXED32, "fixed64": FIXED64, "double": FIXED64,
    "bytes": BYTES, "string": BYTES,
}  # fmt: skip
_LAYOUT = {"fixed32": "<I", "float": "<f", "fixed64": "<Q", "double": "<d"}


def _read_schema(paths: list[Path]) -> tuple[dict[str, list[Entry]], dict[str, dict[str, int]]]:
    """Messages and enumerations by their short names; those within others too."""
    messages: dict[str, list[Entry]] = {}
    enums: dict[str, dict[str, int]] = {}
    field = re.compile(r"(optional |repeated )?([\w.]+) (\w+) = (\d+)")
    for path in paths:
        scopes: list[tuple[str, str]] = []
        text = re.sub(r"//[^\n]*", "", path.read_text())
        for token in re.findall(r"[{}]|[^{};]+", text):
            words = token.split()
            if token == "{":
                continue
            if token == "}":
                scopes.pop()
            elif words[:1] in (["message"], ["enum"], ["oneof"], ["extend"]):
                scopes.append((words[0], words[1]))
                if words[0] == "message":
                    messages[words[1]] = []
                elif words[0] == "enum":
                    enums[words[1]] = {}
            elif scopes and scopes[-1][0] == "enum" and "=" in words:
                enums[scopes[-1][1]][words[0]] = int(words[2])
            elif scopes and (match := field.match(token.strip())):
                owner = next(name for what, name in reversed(scopes) if what == "message")
                label, kind, name, number = match.groups()
                implicit = label is None and scopes[-1][0] != "oneof"
                messages[owner].append(Entry(int(number), name, kind.split(".")[-1], not implicit))
    for name, entries in messages.items():
        messages[name] = [
            Entry(e.number, e.name, "enum" if e.kind in enums else e.kind, e.optional)
            for e in entries
        ]
    return messages, enums


MESSAGES, ENUMS = _read_schema([PROTO / "shared.proto", PROTO / "link.proto"])
LOG_MESSAGES, _ = _read_schema([PROTO / "shared.proto", PROTO / "session_log.proto"])


def varint(value: int) -> bytes:
    value &= (1 << 64) - 1
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def read_varint(data: bytes, at: int) -> tuple[int, int]:
    """The number that begins at `at`, and where it ends."""
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value & (1 << 64) - 1, at
        shift += 7
        if shift > 63:
            raise ValueError("a varint without end")


def pack(fields: list[Field]) -> bytes:
    out = bytearray()
    for number, wire_type, value in fields:
        out += varint(number << 3 | wire_type)
        if wire_type == VARINT:
            out += varint(int(value))
        elif isinstance(value, bytes):
            out += (varint(len(value)) if wire_type == BYTES else b"") + value
    return bytes(out)


def unpack(data: bytes) -> list[Field]:
    fields: list[Field] = []
    at = 0
    while at < len(data):
        tag, at = read_varint(data, at)
        wire_type = tag & 7
        if wire_type == VARINT:
            value, at = read_varint(data, at)
            fields.append((tag >> 3, wire_type, value))
            continue
        if wire_type == BYTES:
            size, at = read_varint(data, at)
        else:
            size = {FIXED32: 4, FIXED64: 8}[wire_type]
        if at + size > len(data):
            raise ValueError("a field longer than its message")
        fields.append((tag >> 3, wire_type, data[at : at + size]))
        at += size
    return fields


def encode(message: str, values: dict) -> bytes:
    """Fields in the order of their numbers; what is 0 and not `optional` is left out."""
    fields: list[Field] = []
    for entry in MESSAGES[message]:
        value = values.get(entry.name)
        if value is None:
            continue
        if entry.kind in MESSAGES:
            fields.append((entry.number, BYTES, encode(entry.kind, value)))
        elif entry.optional or value not in (0, b""):
            if layout := _LAYOUT.get(entry.kind):
                value = struct.pack(layout, value)
            fields.append((entry.number, _SCALARS[entry.kind], value))
    fields.sort(key=lambda f: f[0])
    return pack(fields)


def decode(message: str, data: bytes, schema: dict[str, list[Entry]] = MESSAGES) -> dict:
    """What is absent and not `optional` is 0."""
    entries = {entry.number: entry for entry in schema[message]}
    values: dict = {
        e.name: b"" if _SCALARS[e.kind] == BYTES else 0
        for e in entries.values()
        if e.kind not in schema and not e.optional
    }
    for number, _, value in unpack(data):
        entry = entries.get(number)
        if entry is None:
            continue
        if entry.kind in schema:
            values[entry.name] = decode(entry.kind, bytes(value), schema)
        elif layout := _LAYOUT.get(entry.kind):
            values[entry.name] = struct.unpack(layout, bytes(value))[0]
        else:
            values[entry.name] = value
    return values
