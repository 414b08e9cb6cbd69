"""A session file that cannot grow any more: a full disk, or a file that somebody removed.

Must hold: the session goes on to its end, both sites end with exit code 1, and the report says
that the recording failed.
"""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from client.attack import Attack, Skipped, Verdict
from client.programs import Bench, Program, wait_for

SCRIPT = ("move -3 0.5", "taps 4 4 1 0.2", "lift 0.6 0.5")
TMPFS = "size=300k"


def _session(bench: Bench, patient_file: Path, surgeon_file: Path) -> tuple[Program, Program]:
    patient = bench.patient("--session-file", patient_file)
    script = bench.script(*SCRIPT)
    surgeon = bench.surgeon(
        patient.address(), "--master", script, "--session-file", surgeon_file
    )
    return patient, surgeon


def _verdict(patient: Program, surgeon: Program) -> Verdict:
    codes = surgeon.finish(40, ask=False), patient.finish()
    engaged = all("-> ENGAGED" in p.log for p in (surgeon, patient))
    done = engaged and "ENGAGED -> CLUTCHED: pedal released" in surgeon.log
    told = [p.report.get("reason", "") for p in (surgeon, patient)]
    return Verdict(
        f"exit codes {codes[0]} (surgeon) and {codes[1]} (patient), reasons {told}, "
        + ("session done" if done else "session NOT done"),
        done and codes == (1, 1) and all(told),
    )


def full_disk(bench: Bench) -> Verdict:
    if os.getuid() != 0:
        raise Skipped("needs root, to mount a small disk")
    disk = bench.work / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", TMPFS, "tmpfs", disk]
    if subprocess.run(mount, check=False, capture_output=True).returncode != 0:
        raise Skipped("may not mount")
    try:
        patient, surgeon = _session(bench, disk / "patient.mcap", disk / "surgeon.mcap")
        return _verdict(patient, surgeon)
    finally:
        for program in bench.programs:
            program.finish(5)
        subprocess.run(["umount", "-l", disk], check=False)


def removed_file(bench: Bench) -> Verdict:
    files = bench.work / "patient.mcap", bench.work / "surgeon.mcap"
    patient, surgeon = _session(bench, *files)
    wait_for(lambda: "-> ENGAGED" in surgeon.log, 20)
    for file in files:
        file.unlink()
    return _verdict(patient, surgeon)


ATTACKS = [
    Attack("full-disk", "recording to a disk that fills", full_disk),
    Attack("removed-file", "recording to a file that is removed", removed_file),
]
