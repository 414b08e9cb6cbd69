"""Random edits of a message before it is sealed: every field, every type, and bytes as such."""

from __future__ import annotations

import random

from client.schema import BYTES, FIXED32, FIXED64, MESSAGES, VARINT, Field, pack, unpack

NUMBERS = [0, 1, 2, 5, 6, 7, 127, 128, 1 << 31, (1 << 32) - 1, 1 << 32, 1 << 53, (1 << 53) + 1,
           (1 << 63) - 1, 1 << 63, (1 << 64) - 1]  # fmt: skip
# Zeros, infinities, not a number (quiet and signalling), the smallest and the largest.
FLOATS = [bytes.fromhex(h) for h in (
    "00000000", "00000080", "0000807f", "000080ff", "0000c07f", "010080ff", "01000000",
    "ffff7f7f", "ffff7fff", "0050c347", "01502047",
)]  # fmt: skip
DOUBLES = [bytes.fromhex(h) for h in (
    "0000000000000000", "0000000000000080", "000000000000f07f", "000000000000f0ff",
    "000000000000f87f", "010000000000f0ff", "0100000000000000", "ffffffffffffef7f",
    "0000000065cdcd41", "0100000065cdcd41",
)]  # fmt: skip


class Mutator:
    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)

    def _value(self, wire_type: int, value: int | bytes) -> int | bytes:
        r = self.random
        if wire_type == VARINT:
            flipped = int(value) ^ 1 << r.randrange(64)
            return r.choice([*NUMBERS, flipped, r.getrandbits(r.randrange(1, 65))])
        if wire_type == FIXED32:
            return r.choice([*FLOATS, r.randbytes(4)])
        if wire_type == FIXED64:
            return r.choice([*DOUBLES, r.randbytes(8)])
        data = bytearray(bytes(value))
        if data and r.random() < 0.5:
            data[r.randrange(len(data))] ^= 1 << r.randrange(8)
            return bytes(data)
        return r.choice([b"", bytes(data) * 2, r.randbytes(r.randrange(1, 300))])

    def _other_type(self, field: Field) -> Field:
        wire_type = self.random.choice([VARINT, FIXED64, BYTES, 3, 4, FIXED32])
        value: int | bytes = 0
        if wire_type != VARINT:
            value = self.random.randbytes({FIXED64: 8, FIXED32: 4}.get(wire_type, 3))
        return field[0], wire_type, value

    def _edit(self, fields: list[Field]) -> None:
        r = self.random
        at = r.randrange(len(fields)) if fields else 0
        what = r.choice("value value value value drop twice order number type new".split())
        if not fields or what == "new":
            fields.insert(at, (r.choice([0, 1, 9, 10, 15, 16, 1 << 28]), VARINT, r.getrandbits(9)))
            return
        number, wire_type, value = fields[at]
        if what == "value":
            fields[at] = number, wire_type, self._value(wire_type, value)
        elif what == "drop":
            del fields[at]
        elif what == "twice":
            fields.insert(r.randrange(len(fields)), fields[at])
        elif what == "order":
            r.shuffle(fields)
        elif what == "number":
            fields[at] = r.randrange(20), wire_type, value
        else:
            fields[at] = self._other_type(fields[at])

    def _within(self, message: str, data: bytes) -> bytes:
        """One edit here or in a message within."""
        try:
            fields = unpack(data)
        except (ValueError, IndexError, KeyError):
            return data
        nested = {e.number: e.kind for e in MESSAGES[message] if e.kind in MESSAGES}
        inner = [i for i, f in enumerate(fields) if f[0] in nested and f[1] == BYTES]
        if inner and self.random.random() < 0.7:
            i = self.random.choice(inner)
            number, wire_type, value = fields[i]
            fields[i] = number, wire_type, self._within(nested[number], bytes(value))
        else:
            self._edit(fields)
        return pack(fields)

    def mutate(self, message: str, data: bytes) -> bytes:
        """One to three edits of fields, or of bytes whatever they mean; 1,168 bytes at most."""
        r = self.random
        if message in MESSAGES and r.random() < 0.85:
            for _ in range(r.choice([1, 1, 2, 3])):
                data = self._within(message, data)
            return data[:1168]
        raw = bytearray(data)
        what = r.choice("flip cut grow none noise".split())
        if what == "flip" and raw:
            for _ in range(r.choice([1, 2, 8])):
                raw[r.randrange(len(raw))] ^= 1 << r.randrange(8)
        elif what == "cut":
            raw = raw[: r.randrange(len(raw) + 1)]
        elif what == "grow":
            raw += r.randbytes(r.randrange(1, 900))
        elif what == "none":
            raw = bytearray()
        elif what == "noise":
            raw = bytearray(r.randbytes(r.randrange(1, 1168)))
        return bytes(raw[:1168])
