"""What is known of a session and of its sites: states, devices, settings, what was heard."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from client import wire
from client.schema import ENUMS

STATE = ENUMS["SiteState"]
PARKED, CLUTCHED, ENGAGED, HOLD, RETRACT, STOPPED = (
    STATE[name] for name in ("PARKED", "CLUTCHED", "ENGAGED", "HOLD", "RETRACT", "STOPPED")
)

NO_DEVICES = {
    "hand_axes": 0, "hand_force_peak_n": 0.0, "hand_force_continuous_n": 0.0, "hand_rate_hz": 0.0,
    "hand_lag_s": 0.0,
    "stage_axes": 0, "stage_travel_min_m": 0.0, "stage_travel_max_m": 0.0,
    "stage_travel_side_m": 0.0, "stage_speed_m_per_s": 0.0, "stage_acceleration_m_per_s2": 0.0,
    "stage_rate_hz": 0.0, "stage_lag_s": 0.0, "stage_drags": 0, "sensor_pole_hz": 0.0,
    "sensor_step_n": 0.0, "sensor_range_n": 0.0, "sensor_noise_n": 0.0, "sensor_rate_hz": 0.0,
    "sensor_lag_s": 0.0, "sensor_yield_m_per_n": 0.0,
}  # fmt: skip
HAND = NO_DEVICES | {
    "hand_axes": 3, "hand_force_peak_n": 8.5, "hand_force_continuous_n": 1.4,
    "hand_rate_hz": 1000.0,
}  # fmt: skip
STAGE = NO_DEVICES | {
    "stage_axes": 3, "stage_travel_min_m": -0.05, "stage_travel_max_m": 0.05,
    "stage_travel_side_m": 0.25, "stage_speed_m_per_s": 0.15, "stage_acceleration_m_per_s2": 8.0,
    "stage_rate_hz": 1000.0, "stage_lag_s": 0.0143, "stage_drags": 1, "sensor_pole_hz": 20.0,
    "sensor_step_n": 0.05, "sensor_range_n": 20.0, "sensor_noise_n": 0.015,
    "sensor_rate_hz": 1000.0,
}  # fmt: skip


@dataclass(frozen=True)
class Settings:
    """What a Hello must say so that the other site does not refuse it."""

    hash: int = 0
    coupling: bytes = b"mmt"
    git: bytes = b"attack"


@dataclass
class Heard:
    """What the link part of the next telegram tells of the peer's."""

    newest: int = -1
    before: int = 0
    sent_at_ns: int = 0
    arrived: float = 0.0

    def note(self, number: int, sent_at_ns: int, now: float) -> None:
        if number > self.newest:
            step = number - self.newest
            shifted = (self.before << step | 1 << (step - 1)) if self.newest >= 0 else 0
            self.newest, self.before = number, shifted & 0xFFFFFFFF
            self.sent_at_ns, self.arrived = sent_at_ns, now
        elif number < self.newest:
            self.before |= 1 << (self.newest - 1 - number) & 0xFFFFFFFF


@dataclass
class Session:
    """What both ends know of a session."""

    peer_id: int
    connection_out: int
    keys: wire.Keys
    key_id: int = 0
    began: float = field(default_factory=time.monotonic)
    heard: Heard = field(default_factory=Heard)
    telegrams: int = 0
