"""What stands around the messages: header, keys, sealing. Written from proto/WIRE.md alone."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass, field

from cryptography.exceptions import InvalidTag
from cryptography.hazmat.primitives.ciphers import Cipher, algorithms, modes
from cryptography.hazmat.primitives.ciphers.aead import AESGCM

from client.schema import PROTO

_PAGE = (PROTO / "WIRE.md").read_text()
PROTOCOL_VERSION = int(re.search(r"`protocol_version` in `Hello` is (\d+)", _PAGE)[1])
PROTOCOL_NAME = f"palp/{PROTOCOL_VERSION}".encode()
EXPORTER_LABEL = b"EXPORTER-palp-session"

DATA, CONTROL, PATH, CLOSE = range(4)
HEADER_BYTES = 16
CLEAR_BYTES = 4
TAG_BYTES = 16
DATAGRAM_BYTES_MAX = 1200
NUMBER_MAX = 1 << 53

QUESTION, ANSWER = 0, 1
PATH_REST_BYTES = 26


def header(kind: int, key_id: int, length: int, connection: int, number: int) -> bytes:
    return struct.pack(
        ">BBHIQ", 0x80 | kind, key_id << 6, length & 0xFFFF, connection, number
    )


def kind_of(datagram: bytes) -> int | None:
    """None: not one of ours (DTLS, or broken)."""
    if len(datagram) < HEADER_BYTES + TAG_BYTES or datagram[0] >> 4 != 8:
        return None
    return datagram[0] & 0xF


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
    """One direction of one plane: two keys, a salt, and the count of what was sealed."""

    key: bytes
    salt: bytes
    header_key: bytes
    number: int = 0
    _gcm: AESGCM = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._gcm = AESGCM(self.key)
        self._block = Cipher(algorithms.AES(self.header_key), modes.ECB()).encryptor()

    def _nonce(self, number: int) -> bytes:
        last = int.from_bytes(self.salt[4:], "big") ^ number
        return self.salt[:4] + last.to_bytes(8, "big")

    def seal(self, kind: int, connection: int, message: bytes, key_id: int = 0) -> bytes:
        head = header(kind, key_id, len(message) + 16, connection, self.number)
        sealed = head + self._gcm.encrypt(self._nonce(self.number), message, head)
        self.number += 1
        return self._masked(sealed)

    def _masked(self, datagram: bytes) -> bytes:
        """With connection and number hidden, or shown again."""
        mask = self._block.update(datagram[-TAG_BYTES:])
        part = bytes(a ^ b for a, b in zip(datagram[CLEAR_BYTES:HEADER_BYTES], mask))
        return datagram[:CLEAR_BYTES] + part + datagram[HEADER_BYTES:]

    def open(self, datagram: bytes, connection: int) -> tuple[int, bytes] | None:
        """Number and message. None: of another connection, or the tag does not fit."""
        shown = self._masked(datagram)
        told, number = struct.unpack_from(">IQ", shown, CLEAR_BYTES)
        if told != connection:
            return None
        try:
            head, rest = shown[:HEADER_BYTES], shown[HEADER_BYTES:]
            return number, self._gcm.decrypt(self._nonce(number), rest, head)
        except InvalidTag:
            return None


KEY_BYTES = 32 + 12 + 32
EXPORTED_BYTES = 4 * KEY_BYTES + 8


@dataclass
class Keys:
    """What a handshake gives: both planes, both directions, the connection ids of control."""

    exported: bytes
    surgeon: bool

    def __post_init__(self) -> None:
        parts = [self.exported[KEY_BYTES * i :][:KEY_BYTES] for i in range(4)]
        sealers = [Sealer(part[:32], part[32:44], part[44:]) for part in parts]
        ids = struct.unpack(">II", self.exported[4 * KEY_BYTES :])
        own, peer = (0, 1) if self.surgeon else (1, 0)
        self.data_out, self.data_in = sealers[own], sealers[peer]
        self.control_out, self.control_in = sealers[2 + own], sealers[2 + peer]
        self.control_id_out = ids[own] | 1
        self.control_id_in = ids[peer] | 1
