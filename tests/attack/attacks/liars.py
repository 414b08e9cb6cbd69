"""A peer with good keys and a good certificate says what is not true.

It can: say any number that the wire takes and any that it does not, in every field, at any time;
overstate what energy it has; say devices that cannot be.
Must hold: the hand gains no more energy than the law's bound; no site falls silent or dies; the
stage stays within its gates; who says devices that cannot be is told so.
"""

from __future__ import annotations

import math
import random
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from client.attack import Attack, Verdict, learn_settings
from client.programs import Bench
from client.schema import ENUMS
from client.session import ENGAGED, HAND, Settings
from client.session_file import hand_of, messages
from client.site import Patient, Surgeon

# What the hand may gain from any peer, in mJ: docs/safety.md, and a margin of a tick.
ENERGY_MAX_MJ = {"mmt": 1.05, "wave": 1.05, "tdpa": 1.05}  # direct has no bound
DEPTH_MAX_MM = 3  # Less than the simulated tissue is known for, where the stage stops anyway.
FORCE_STEP_MAX_N = 0.5  # in 10 ms
TAPS = ("move -3 0.5", "taps 60 5 0.8 0.1")

LENGTH, SPEED, FORCE, ENERGY = 10.0, 1000.0, 1e5, 1e9
LIMITS = {"position_m": LENGTH, "velocity_m_per_s": SPEED, "force_n": FORCE}
MODEL_LIMITS = {
    **{f"c{i}_n": FORCE for i in range(1, 6)}, "residual_n": FORCE, "relaxing_fast": FORCE,
    "relaxing_slow": FORCE, "surface_m": LENGTH, "depth_max_m": LENGTH, "swing_m": LENGTH,
    **{f"stiffness{i}_n_per_m": FORCE for i in range(1, 13)},
    "swing_quadrature_m": LENGTH, "swing_rad_per_s": SPEED,
}  # fmt: skip
PAYLOADS = {
    "mmt": ("model", MODEL_LIMITS),
    "wave": ("wave", {"wave_integral_sqrt_w_s": ENERGY, "wave_energy_j": ENERGY}),
    "tdpa": ("tdpa", {"energy_in_j": ENERGY}),
    "direct": ("", {}),
}


class Liar:
    """Draws numbers: mostly the limits themselves, sometimes beyond them or none at all."""

    def __init__(self, seed: int, law: str, beyond: float) -> None:
        self.random = random.Random(seed)
        self.law, self.beyond = law, beyond

    def number(self, limit: float) -> float:
        if self.random.random() < self.beyond:
            return self.random.choice([math.nan, math.inf, -math.inf, 2 * limit, -2 * limit])
        # Just within: the nearest float must not lie beyond.
        share = self.random.choice([0.999999, -0.999999, 0.5, 1e-3, 1e-6, 0, self.random.random()])
        return share * limit

    def sample(self, t: float) -> dict:
        told: dict = {name: self.number(limit) for name, limit in LIMITS.items()}
        name, limits = PAYLOADS[self.law]
        if name:
            told[name] = {field: self.number(limit) for field, limit in limits.items()}
        if name == "model":
            told[name]["version"] = 1 + int(t * 100)
        return told

    def edit(self, telegram: dict) -> dict:
        """Places, states and epochs as well, now and then."""
        site = telegram["site"]
        if self.random.random() < 0.3:
            site["x_m"], site["y_m"] = self.number(LENGTH), self.number(LENGTH)
        if self.random.random() < 0.02:
            site["state"] = self.random.choice(list(ENUMS["SiteState"].values()))
        if self.random.random() < 0.02:
            site["epoch"] = self.random.choice([0, 1, 2, (1 << 32) - 1, site["epoch"] + 1])
        return telegram


def lying_patient(bench: Bench) -> Verdict:
    """Limits as numbers, in each law: does its surgeon go on speaking?"""
    wrong: list[str] = []
    for law in PAYLOADS:
        with Patient(bench.identity("patient")) as patient:
            surgeon = bench.surgeon(
                patient.address, "--coupling", law, "--master", bench.script(*TAPS)
            )
            liar = Liar(bench.seed, law, beyond=0.0)
            patient.run(10, lambda: patient.state == ENGAGED)
            patient.run(0.5)
            patient.sample = liar.sample
            patient.run(bench.seconds / 8)
            liar.beyond = 0.3
            patient.edit = liar.edit
            patient.run(bench.seconds / 8)
            patient.sample = lambda t: {"position_m": -0.01}
            patient.edit = lambda telegram: telegram
            before = patient.counts["telegrams"]
            patient.run(0.5)
            spoke = patient.counts["telegrams"] - before
            sessions = patient.counts["sessions"]
            surgeon.finish()
        unsent = surgeon.report.get("unsent")
        if spoke < 250 or unsent != 0 or sessions != 1:
            wrong.append(f"{law}: {spoke} telegrams in the last 0.5 s, {unsent} unsent")
    return Verdict("; ".join(wrong) or "each surgeon goes on speaking", not wrong)


def _pump(patient: Patient, law: str) -> Callable[[float], dict]:
    """Pulls with the hand's own motion: a force whenever it moves out, none when it moves in."""
    charge = 0.0
    version = 1

    def sample(t: float) -> dict:
        nonlocal charge, version
        hand = patient.peer_sample
        outward = hand.get("velocity_m_per_s", 0.0) < -0.002
        where = hand.get("position_m", 0.0)
        told = {"position_m": where, "force_n": 8.0 if outward else 0.0}
        if law == "wave":
            charge += 2.0 * patient.period if outward else -1.0 * patient.period
            told["wave"] = {"wave_integral_sqrt_w_s": charge, "wave_energy_j": 1e6 * (1 + t)}
        elif law == "tdpa":
            told["tdpa"] = {"energy_in_j": 1e3 * (1 + t)}
        elif law == "mmt":
            version += 1
            told["model"] = {
                "version": version, "c1_n": 0.8 if outward else 0.01, "depth_max_m": 0.008,
                "surface_m": where - 0.005 if outward else 0.0, "residual_n": 0.01,
            }  # fmt: skip
        return told

    return sample


def overstated(law: str) -> Callable[[Bench], Verdict]:
    def run(bench: Bench) -> Verdict:
        file = bench.work / "surgeon.mcap"
        with Patient(bench.identity("patient")) as patient:
            patient.period = 0.001
            patient.sample = _pump(patient, law)
            surgeon = bench.surgeon(
                patient.address, "--coupling", law, "--session-file", file,
                "--master", bench.script(*TAPS), "--force-engage", "--grip", "light",
            )  # fmt: skip
            patient.run(10, lambda: patient.state == ENGAGED)
            patient.run(bench.seconds)
            surgeon.finish()
        told = hand_of(file)
        gentle = law != "mmt" or told.force_step <= FORCE_STEP_MAX_N  # The others promise none.
        held = told.energy_gained * 1e3 <= ENERGY_MAX_MJ[law] and told.engaged > 1000
        return Verdict(str(told), held and gentle)

    return run


def lying_surgeon(bench: Bench) -> Verdict:
    """Telegrams of every kind; the stage keeps to its gates."""
    settings = learn_settings(bench)
    file = bench.work / "patient.mcap"
    gate = f"motion_gate.depth_max_mm={DEPTH_MAX_MM}"
    patient = bench.patient("--session-file", file, "--set", gate)
    with Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        liar = Liar(bench.seed, "mmt", beyond=0.01)
        surgeon.run(10, lambda: surgeon.established)
        surgeon.pedal = True
        surgeon.run(1)
        end = time.monotonic() + bench.seconds
        while time.monotonic() < end:
            surgeon.sample = liar.sample
            surgeon.run(0.3)
            surgeon.sample = lambda t: {"position_m": 0.02 * math.sin(2.5 * t)}
            surgeon.run(1.7)
        # Last: an epoch or a stop that was told once holds for the session.
        surgeon.sample, surgeon.edit = liar.sample, liar.edit
        surgeon.run(1)
        lives = surgeon.run(2, lambda: surgeon.established)
        sent = surgeon.counts["telegrams sent"]
    code = patient.finish()
    stage = _stage_of(messages(file, "patient/tick"))
    held = lives and code in (0, 4) and stage.engaged > 200
    return Verdict(f"{sent} telegrams, {stage}, exit code {code}", held and stage.within_gates)


@dataclass
class Stage:
    """What the patient's stage did, beside its gates."""

    engaged: int = 0
    deepest: float = 0.0  # [m]
    force: float = 0.0  # [N]
    speed: float = 0.0  # [m/s], over 20 ms: ticks may be late

    def __str__(self) -> str:
        return (
            f"{self.engaged} ticks engaged, tip {self.deepest * 1e3:.1f} mm deep, "
            f"{self.force:.2f} N and {self.speed:.2f} m/s at most"
        )

    @property
    def within_gates(self) -> bool:
        return self.deepest < (DEPTH_MAX_MM + 1.3) * 1e-3 and self.force < 5.5 and self.speed < 0.2


def _stage_of(ticks: Iterable[tuple[int, dict]]) -> Stage:
    stage = Stage()
    recent: deque[tuple[int, float]] = deque()
    for at, tick in ticks:
        stage.engaged += tick["state"] == ENGAGED
        stage.deepest = max(stage.deepest, tick["position_m"])
        stage.force = max(stage.force, tick["force_n"])
        recent.append((at, tick["position_m"]))
        while at - recent[0][0] > 20_000_000:
            recent.popleft()
        if (span := at - recent[0][0]) > 15_000_000:
            speed = abs(tick["position_m"] - recent[0][1]) / (span * 1e-9)
            stage.speed = max(stage.speed, speed)
    return stage


BAD_DEVICES = {
    "hand_axes": [0, 7, (1 << 32) - 1],
    "hand_force_peak_n": [0.0, -1.0, 1001.0, math.nan, math.inf],
    "hand_force_continuous_n": [0.0, 9.0, math.nan],
    "hand_rate_hz": [0.0, 1e6, math.nan, None],
}


def wrong_devices(bench: Bench) -> Verdict:
    settings: Settings = learn_settings(bench)
    patient = bench.patient()
    address = patient.address()
    wrong: list[str] = []
    tried = 0
    for name, values in BAD_DEVICES.items():
        for value in values:
            tried += 1
            with Surgeon(bench.identity("surgeon"), address, settings) as surgeon:
                surgeon.devices = HAND | {name: value}
                surgeon.run(3, lambda: surgeon.established or bool(surgeon.byes))
                said = surgeon.byes[0]["text"].decode() if surgeon.byes else "nothing"
                if surgeon.established or "hand" not in said:
                    wrong.append(f"{name} = {value}: said '{said}'")
    with Surgeon(bench.identity("surgeon"), address, settings) as surgeon:
        honest = surgeon.run(3, lambda: surgeon.established)
    return Verdict(
        f"{tried} devices that cannot be: " + ("; ".join(wrong) or "all refused by name"),
        honest and not wrong,
    )


ATTACKS = [
    Attack("lying-patient", "limits, NaN and beyond from a patient: surgeons speak", lying_patient),
    Attack("lying-surgeon", "the same from a surgeon: the stage keeps to its gates", lying_surgeon),
    *(
        Attack(f"energy-{law}", f"a patient that overstates its energy, {law}", overstated(law))
        for law in ENERGY_MAX_MJ
    ),
    Attack("devices", "devices in a Hello that cannot be", wrong_devices),
]
