"""DTLS 1.2 over memory BIOs: one handshake as either role, with certificates that may be wrong."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from OpenSSL import SSL, crypto

from client import wire

_NO_QUERY_MTU = 0x1000
_NO_TICKET = 0x4000


@dataclass(frozen=True)
class Identity:
    """A key and certificates in PEM. What the other end shows is never doubted here."""

    certificate: bytes
    key: bytes
    chain: tuple[bytes, ...] = ()

    @staticmethod
    def of(folder: Path) -> Identity:
        certificate = (folder / "certificate.pem").read_bytes()
        return Identity(certificate, (folder / "key.pem").read_bytes())


def _context(identity: Identity | None) -> SSL.Context:
    context = SSL.Context(SSL.DTLS_METHOD)
    context.set_options(_NO_QUERY_MTU | _NO_TICKET)
    context.set_cipher_list(b"ECDHE+AESGCM")
    context.set_alpn_protos([wire.PROTOCOL_NAME])
    context.set_alpn_select_callback(lambda _, offered: wire.PROTOCOL_NAME)
    context.set_verify(SSL.VERIFY_PEER, lambda *_: True)
    if identity is not None:
        pem = crypto.FILETYPE_PEM
        context.use_certificate(crypto.load_certificate(pem, identity.certificate))
        context.use_privatekey(crypto.load_privatekey(pem, identity.key))
        for certificate in identity.chain:
            context.add_extra_chain_cert(crypto.load_certificate(pem, certificate))
    return context


def records(stream: bytes) -> list[bytes]:
    """The records of a flight, each to travel as a datagram of its own."""
    out = []
    while len(stream) >= 13:
        size = 13 + int.from_bytes(stream[11:13], "big")
        out.append(stream[:size])
        stream = stream[size:]
    return out


def is_record(datagram: bytes) -> bool:
    return bool(datagram) and 20 <= datagram[0] <= 63


def begins_handshake(datagram: bytes) -> bool:
    """A ClientHello of epoch 0."""
    return len(datagram) > 13 and datagram[0] == 22 and datagram[3:5] == b"\0\0" and (
        datagram[13] == 1
    )


class Handshake:
    """Give it what came, send what `take` gives; `keys` is there once it is done."""

    def __init__(self, surgeon: bool, identity: Identity | None) -> None:
        self._surgeon = surgeon
        self._tls = SSL.Connection(_context(identity), None)
        self._tls.set_ciphertext_mtu(1200)
        if surgeon:
            self._tls.set_connect_state()
        else:
            self._tls.set_accept_state()
        self.keys: wire.Keys | None = None
        self.failure: str | None = None
        if surgeon:
            self._go_on()

    def _go_on(self) -> None:
        """Also sends again what was lost: OpenSSL looks at its own timer."""
        if self.keys or self.failure:
            return
        try:
            self._tls.do_handshake()
        except SSL.WantReadError:
            return
        except SSL.Error as error:
            self.failure = str(error) or type(error).__name__
            return
        context = bytes([wire.PROTOCOL_VERSION])
        exported = self._tls.export_keying_material(
            wire.EXPORTER_LABEL, wire.EXPORTED_BYTES, context
        )
        self.keys = wire.Keys(exported, self._surgeon)

    def feed(self, datagram: bytes) -> None:
        self._tls.bio_write(datagram)
        if self.keys is None:
            self._go_on()
            return
        try:  # An alert, or the end of their flight again.
            self._tls.recv(4096)
        except SSL.Error as error:
            if not isinstance(error, SSL.WantReadError):
                self.failure = str(error) or type(error).__name__

    def wait(self) -> None:
        self._go_on()

    def take(self) -> list[bytes]:
        try:
            return records(self._tls.bio_read(1 << 16))
        except SSL.Error:
            return []
