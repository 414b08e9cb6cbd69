"""What stands around the messages: header, keys, sealing. Written from proto/WIRE.md alone."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives.ciphers.aead import AESGCM

PROTOCOL_VERSION = 6
EXPORTER_LABEL = b"EXPORTER-palp-session"

DATA, CONTROL, PATH, CLOSE = range(4)
HEADER_BYTES = 16
DATAGRAM_BYTES_MAX = 1200
NUMBER_MAX = 1 << 53

QUESTION, ANSWER = 0, 1
PATH_REST_BYTES = 26


def header(kind: int, key_id: int, length: int, connection: int, number: int) -> bytes:
    return struct.pack(
        ">BBHIQ", 0x80 | kind, key_id << 6, length & 0xFFFF, connection, number
    )


@dataclass(frozen=True)
class Header:
    kind: int
    key_id: int
    connection: int
    number: int


def read_header(datagram: bytes) -> Header | None:
    """None: not one of ours (DTLS, or broken)."""
    if len(datagram) < HEADER_BYTES or datagram[0] >> 4 != 8:
        return None
    first, second, _, connection, number = struct.unpack_from(">BBHIQ", datagram)
    return Header(first & 0xF, second >> 6, connection, number)


def path_message(what: int, rest: bytes) -> bytes:
    """A question about a path, or the answer to one."""
    return bytes([what]) + rest


def path_answer(message: bytes) -> bytes | None:
    """The honest answer to a path message; None where none is due."""
    if len(message) == 1 + PATH_REST_BYTES and message[0] == QUESTION:
        return path_message(ANSWER, message[1:])
    return None


@dataclass
class Sealer:
    """One direction of one plane: a key, a salt, and the count of what was sealed."""

    key: bytes
    salt: bytes
    number: int = 0
    _gcm: AESGCM = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._gcm = AESGCM(self.key)

    def _nonce(self, number: int) -> bytes:
        last = int.from_bytes(self.salt[4:], "big") ^ number
        return self.salt[:4] + last.to_bytes(8, "big")

    def seal(self, kind: int, connection: int, message: bytes, key_id: int = 0) -> bytes:
        head = header(kind, key_id, len(message) + 16, connection, self.number)
        sealed = head + self._gcm.encrypt(self._nonce(self.number), message, head)
        self.number += 1
        return sealed

    def open(self, datagram: bytes) -> bytes | None:
        """None: the tag does not fit."""
        head, number = datagram[:HEADER_BYTES], int.from_bytes(datagram[8:16], "big")
        try:
            return self._gcm.decrypt(self._nonce(number), datagram[HEADER_BYTES:], head)
        except InvalidTag:
            return None


EXPORTED_BYTES = 4 * 44 + 8


@dataclass
class Keys:
    """What a handshake gives: both planes, both directions, the connection ids of control."""

    exported: bytes
    surgeon: bool

    def __post_init__(self) -> None:
        parts = [self.exported[44 * i : 44 * i + 44] for i in range(4)]
        sealers = [Sealer(part[:32], part[32:]) for part in parts]
        ids = struct.unpack(">II", self.exported[176:184])
        own, peer = (0, 1) if self.surgeon else (1, 0)
        self.data_out, self.data_in = sealers[own], sealers[peer]
        self.control_out, self.control_in = sealers[2 + own], sealers[2 + peer]
        self.control_id_out = ids[own] | 1
        self.control_id_in = ids[peer] | 1
