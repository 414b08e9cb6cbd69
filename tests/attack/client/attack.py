"""What an attack is: a name, what it does and what must hold, and a function that tries it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from client.programs import Bench
from client.session import Settings
from client.site import Patient


@dataclass(frozen=True)
class Verdict:
    """One line of what was measured, and whether what must hold held."""

    measured: str
    held: bool


class Skipped(Exception):
    """The attack cannot be tried here; says why."""


@dataclass(frozen=True)
class Attack:
    name: str
    means: str  # one line for --list
    run: Callable[[Bench], Verdict]
    seconds: float = 8  # how long it goes on unless told otherwise
    seconds_long: float = 30  # the same in the long round


def learn_settings(bench: Bench, coupling: str = "mmt") -> Settings:
    """The hash of settings stands in no document: a real surgeon's Hello says it."""
    with Patient(bench.identity("patient")) as patient:
        surgeon = bench.surgeon(patient.address, "--coupling", coupling)
        if not patient.run(20, lambda: bool(patient.hello_heard)):
            raise RuntimeError(f"no surgeon asks: {surgeon.log}")
        surgeon.finish()
        return patient.settings
