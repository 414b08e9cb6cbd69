"""One end of a session, honest until told to lie: surgeon or patient, after WIRE.md and STATES.md.

    site = Surgeon(identity, peer=("127.0.0.1", 9000), settings=settings)
    site.run(3, until=lambda: site.established)

An attack lies through the hooks: `sample`, `edit`, `on_tick`.
"""

from __future__ import annotations

import random
import select
import socket
import time
from collections import Counter
from collections.abc import Callable

from client import wire
from client.dtls import Handshake, Identity, begins_handshake, is_record
from client.schema import ENUMS, decode, encode
from client.session import (
    CLUTCHED,
    ENGAGED,
    HAND,
    HOLD,
    PARKED,
    RETRACT,
    STAGE,
    STOPPED,
    Session,
    Settings,
)

Address = tuple[str, int]

HELLO_EVERY_S = 0.2
HANDSHAKE_AGAIN_S = 1.5


class Site:
    """The common half; `Surgeon` and `Patient` say who speaks first and what states follow."""

    surgeon: bool
    devices: dict

    def __init__(
        self,
        identity: Identity | None,
        settings: Settings = Settings(),
        bind: Address = ("127.0.0.1", 0),
    ) -> None:
        self.identity, self.settings = identity, settings
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        self.socket.bind(bind)
        self.socket.setblocking(False)
        self.peer: Address | None = None
        self.handshakes: dict[Address, Handshake] = {}
        self.keys: wire.Keys | None = None  # of the newest handshake
        self.session: Session | None = None
        self.new_ids()
        self.state, self.epoch = PARKED, 0
        self.peer_site: dict = {}
        self.peer_sample: dict = {}
        self.counts: Counter[str] = Counter()
        self.byes: list[dict] = []
        self.hello_heard: dict = {}
        self.period = 0.002
        self.sample: Callable[[float], dict] = lambda t: {"position_m": -0.01}
        self.edit: Callable[[dict], dict | bytes] = lambda telegram: telegram
        self.on_tick: Callable[[float], None] = lambda now: None
        self._last_hello = 0.0
        self._last_telegram = 0.0
        self.longest_pause = 0.0  # between own telegrams [s]: what the peer may hold for

    def new_ids(self) -> None:
        """A session id is good for one session only."""
        self.own_id = random.getrandbits(63) | 1
        self.connection_in = random.getrandbits(31) & ~1 | 2

    @property
    def address(self) -> Address:
        return self.socket.getsockname()

    @property
    def established(self) -> bool:
        return self.session is not None and self.session.telegrams > 0

    def close(self) -> None:
        self.socket.close()

    def __enter__(self):
        return self

    def __exit__(self, *_) -> None:
        self.leave()
        self.close()

    # ---- Sending

    def send(self, datagram: bytes, to: Address | None = None, via=None) -> None:
        """`via`: another socket, so from another address."""
        try:
            (via or self.socket).sendto(datagram, to or self.peer)
        except OSError:
            self.counts["unsent"] += 1

    def seal(self, kind: int, message: bytes) -> bytes:
        """As a datagram of the present session, or of the handshake before it."""
        if kind == wire.DATA:
            session = self.session
            return session.keys.data_out.seal(
                kind, session.connection_out, message, session.key_id
            )
        keys = self.session.keys if self.session else self.keys
        return keys.control_out.seal(kind, keys.control_id_out, message)

    def seal_control(self, keys: wire.Keys, message: bytes) -> bytes:
        return keys.control_out.seal(wire.CONTROL, keys.control_id_out, message)

    def hello(self) -> dict:
        return {
            "protocol_version": wire.PROTOCOL_VERSION,
            "role": ENUMS["Role"]["SURGEON" if self.surgeon else "PATIENT"],
            "session_id": self.own_id,
            "peer_session_id": self.session.peer_id if self.session else 0,
            "connection_id": self.connection_in if self.session else 0,
            "settings_hash": self.settings.hash,
            "coupling": self.settings.coupling,
            "git": self.settings.git,
            "devices": self.devices,
        }

    def send_hello(self, keys: wire.Keys, to: Address) -> None:
        message = encode("Hello", self.hello())
        self.send(self.seal_control(keys, message), to)
        self._last_hello = time.monotonic()

    def leave(self) -> None:
        if self.session is None:
            return
        bye = encode("Bye", {"session_id": self.own_id, "peer_session_id": self.session.peer_id})
        for _ in range(3):
            self.send(self.seal(wire.CLOSE, bye))
        self.session = None

    def telegram(self) -> dict:
        session = self.session
        heard = session.heard
        now = time.monotonic()
        told: dict = {"sent_at_ns": int((now - session.began) * 1e9)}
        if heard.newest >= 0:
            told |= {
                "echo_ns": heard.sent_at_ns,
                "hold_us": int((now - heard.arrived) * 1e6),
                "newest_number": heard.newest,
                "before_newest": heard.before,
            }
        told["site"] = {"state": self.state, "epoch": self.epoch, "x_m": 0.0, "y_m": 0.0}
        told["sample"] = self.sample(now - session.began)
        return told

    def send_telegram(self) -> None:
        told = self.edit(self.telegram())
        message = told if isinstance(told, bytes) else encode("Telegram", told)
        self.send(self.seal(wire.DATA, message))
        self.counts["telegrams sent"] += 1
        now = time.monotonic()
        self.longest_pause = max(self.longest_pause, now - (self._last_telegram or now))
        self._last_telegram = now

    # ---- Receiving

    def receive(self) -> None:
        for _ in range(256):
            try:
                datagram, source = self.socket.recvfrom(65535)
            except BlockingIOError:
                return
            except OSError:
                continue
            if is_record(datagram):
                self.on_record(datagram, source)
            elif (kind := wire.kind_of(datagram)) is not None:
                self.on_ours(kind, datagram, source)

    def on_record(self, datagram: bytes, source: Address) -> None:
        handshake = self.handshakes.get(source)
        if not self.surgeon and begins_handshake(datagram) and (
            handshake is None or handshake.keys or handshake.failure
        ):
            handshake = self.handshakes[source] = Handshake(False, self.identity)
        if handshake is None:
            return
        was_done = handshake.keys is not None
        handshake.feed(datagram)
        for record in handshake.take():
            self.send(record, source)
        if handshake.keys and not was_done:
            self.counts["handshakes"] += 1
            self.keys = handshake.keys
            if self.surgeon:
                self.send_hello(self.keys, source)

    def on_ours(self, kind: int, datagram: bytes, source: Address) -> None:
        session = self.session
        if kind == wire.DATA:
            if session:
                self.on_data(session.keys.data_in.open(datagram, self.connection_in))
            return
        for keys in {id(k): k for k in (self.keys, session and session.keys) if k}.values():
            if opened := keys.control_in.open(datagram, keys.control_id_in):
                self.on_control(kind, opened[1], keys, source)
                return

    def on_data(self, opened: tuple[int, bytes] | None) -> None:
        if opened is None:
            self.counts["forged"] += 1
            return
        number, message = opened
        told = decode("Telegram", message)
        session = self.session
        session.telegrams += 1
        if number > session.heard.newest:
            self.peer_site, self.peer_sample = told["site"], told["sample"]
        session.heard.note(number, told["sent_at_ns"], time.monotonic())
        self.counts["telegrams"] += 1

    def on_control(self, kind: int, message: bytes, keys: wire.Keys, source: Address) -> None:
        if kind == wire.PATH:
            self.counts["questions"] += 1
            answer = wire.path_answer(message)
            if answer:
                self.send(keys.control_out.seal(wire.PATH, keys.control_id_out, answer), source)
        elif kind == wire.CONTROL:
            self.counts["hellos"] += 1
            self.hello_heard = decode("Hello", message)
            self.on_hello(self.hello_heard, keys, source)
        elif kind == wire.CLOSE:
            bye = decode("Bye", message)
            self.byes.append(bye)
            if self.session and bye["peer_session_id"] == self.own_id:
                self.end_session()

    def end_session(self) -> None:
        self.session = None
        self._last_telegram = 0.0
        self.counts["ended"] += 1
        self.new_ids()
        self.state, self.epoch = PARKED, 0

    def begin_session(self, hello: dict, keys: wire.Keys, source: Address) -> None:
        self.peer = source
        self.session = Session(hello["session_id"], hello.get("connection_id", 0), keys)
        self.counts["sessions"] += 1
        self.state, self.epoch = PARKED, 0

    def on_hello(self, hello: dict, keys: wire.Keys, source: Address) -> None:
        raise NotImplementedError

    def supervise(self, now: float) -> None:
        raise NotImplementedError

    # ---- Running

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Lives for so long, or until that holds; then true."""
        end = time.monotonic() + seconds
        due = time.monotonic()
        while (now := time.monotonic()) < end:
            self.receive()
            if until():
                return True
            if now >= due:
                due = max(due + self.period, now)
                self.tick(now)
            select.select([self.socket], [], [], max(0.0, min(due, end) - time.monotonic()))
        return until()

    def tick(self, now: float) -> None:
        self.supervise(now)
        if self.session and self.session.connection_out:
            self.send_telegram()
        self.on_tick(now)


class Surgeon(Site):
    """Asks, shakes hands as the client, engages while `pedal` is down."""

    surgeon = True
    devices = HAND

    def __init__(self, identity: Identity | None, peer: Address, *args, **kwargs) -> None:
        super().__init__(identity, *args, **kwargs)
        self.peer = peer
        self.pedal = False
        self._shook = 0.0
        self._heard_before = 0  # Hellos, before the newest handshake
        self._engaged = 0.0

    def handshake(self, now: float) -> None:
        handshake = self.handshakes[self.peer] = Handshake(True, self.identity)
        for record in handshake.take():
            self.send(record)
        self._shook = now
        self._heard_before = self.counts["hellos"]

    def supervise(self, now: float) -> None:
        if self.session is None:
            self._ask(now)
            return
        if self.session.telegrams == 0:
            self._ask_within(now)
            return
        if self.session.telegrams < 20:
            return
        theirs = self.peer_site.get("state", PARKED)
        if self.state == PARKED and theirs == CLUTCHED:
            self.state = CLUTCHED
        elif self.state == CLUTCHED and self.pedal and theirs == CLUTCHED:
            if now - self._engaged > 0.5:
                self.state, self.epoch, self._engaged = ENGAGED, self.epoch + 1, now
        elif self.state == ENGAGED:
            refused = theirs == CLUTCHED and now - self._engaged > 1
            if not self.pedal or refused:
                self.state = CLUTCHED
            elif theirs in (RETRACT, PARKED, STOPPED):
                self.state = PARKED

    def _ask(self, now: float) -> None:
        handshake = self.handshakes.get(self.peer)
        if handshake is None or (handshake.failure and now - self._shook > 0.2):
            self.handshake(now)
        elif handshake.keys is None:
            handshake.wait()
            for record in handshake.take():
                self.send(record)
        elif now - self._last_hello > HELLO_EVERY_S:
            unanswered = self.counts["hellos"] == self._heard_before
            if unanswered and now - self._shook > HANDSHAKE_AGAIN_S:
                self.handshake(now)
            else:
                self.send_hello(handshake.keys, self.peer)

    def _ask_within(self, now: float) -> None:
        """A peer that says nothing did not hear our last Hello, or took another surgeon's."""
        if now - self.session.began > HANDSHAKE_AGAIN_S:
            self.end_session()
            self.handshake(now)
        elif now - self._last_hello > HELLO_EVERY_S:
            self.send_hello(self.session.keys, self.peer)

    def on_hello(self, hello: dict, keys: wire.Keys, source: Address) -> None:
        if self.session is None and hello.get("peer_session_id") == self.own_id:
            self.begin_session(hello, keys, source)
            self.send_hello(keys, source)


class Patient(Site):
    """Waits, shakes hands as the server, follows the surgeon's pedal."""

    surgeon = False
    devices = STAGE

    def on_hello(self, hello: dict, keys: wire.Keys, source: Address) -> None:
        session = self.session
        if self.settings.hash == 0:
            self.settings = Settings(hello["settings_hash"], hello["coupling"], hello["git"])
        if session is None or session.peer_id != hello["session_id"]:
            self.begin_session(hello, keys, source)
        elif session.keys is not keys:  # New keys within a session: numbers go on.
            keys.data_out.number = session.keys.data_out.number
            session.keys, session.key_id = keys, (session.key_id + 1) % 4
        self.session.connection_out = hello.get("connection_id", 0)
        self.send_hello(keys, source)

    def supervise(self, now: float) -> None:
        if self.session is None or self.session.telegrams < 20:
            return
        theirs = self.peer_site.get("state", PARKED)
        if self.state == PARKED:
            self.state = CLUTCHED
        elif theirs == ENGAGED:
            self.state, self.epoch = ENGAGED, self.peer_site["epoch"]
        elif self.state == ENGAGED and theirs != HOLD:
            self.state = CLUTCHED
