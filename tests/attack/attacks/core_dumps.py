"""A program dies, and whoever reads its core file has the keys of the session.

He can: make it die (SIGABRT), with core files allowed by the shell that started it.
Must hold: the running programs allow no core file, are not dumpable, and leave none.
"""

from __future__ import annotations

import os
import re
import resource
import shutil
import signal
from pathlib import Path

from client.attack import Attack, Verdict, learn_settings
from client.programs import Bench, Program
from client.site import Surgeon

NOBODY = 65534


def _core_limit(program: Program) -> str:
    limits = Path(f"/proc/{program.pid}/limits").read_text()
    return re.search(r"Max core file size\s+(\S+)", limits).group(1)


def _dumpable(program: Program) -> bool:
    """What is not belongs to root in /proc; root's own cannot be told apart."""
    return os.stat(f"/proc/{program.pid}/environ").st_uid != 0


def _allow_cores() -> None:
    resource.setrlimit(resource.RLIMIT_CORE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))


def _give_away(bench: Bench) -> dict:
    """As root the programs run as another user, or /proc would not tell."""
    if os.getuid() != 0:
        return {}
    os.chmod(bench.work, 0o777)
    for path in [bench.keys, *bench.keys.rglob("*")]:
        os.chown(path, NOBODY, NOBODY)
    folder = bench.work / "bin"
    shutil.copytree(bench.bin, folder, ignore=lambda _, names: [
        n for n in names if n not in ("palp-patient", "palp-surgeon")
    ])  # fmt: skip
    bench.bin = folder
    return {"user": NOBODY, "group": NOBODY, "extra_groups": []}


def core_dumps(bench: Bench) -> Verdict:
    settings = learn_settings(bench)
    user = _give_away(bench)
    patient = bench.patient(preexec_fn=_allow_cores, cwd=bench.work, **user)
    wrong: list[str] = []
    with Surgeon(bench.identity("surgeon"), patient.address(), settings) as surgeon:
        surgeon.run(10, lambda: surgeon.established)
        surgeon.run(0.3)
        key = surgeon.session.keys.data_out.key
        real = bench.surgeon(
            surgeon.address, "--set", "give_up_after_s=60", preexec_fn=_allow_cores,
            cwd=bench.work, **user,
        )  # fmt: skip
        surgeon.run(0.5)
        for program in (patient, real):
            name = program.log_path.stem.split("-")[-1]
            if (limit := _core_limit(program)) != "0":
                wrong.append(f"{name} may leave a core file ({limit})")
            if user and _dumpable(program):
                wrong.append(f"{name} is dumpable")
        patient.process.send_signal(signal.SIGABRT)
        patient.process.wait()
        surgeon.session = None
    cores = [p for p in bench.work.iterdir() if p.name.startswith("core") and p.is_file()]
    if any(key in core.read_bytes() for core in cores):
        wrong.append("the key of the session stands in a core file")
    elif cores:
        wrong.append("a core file was left")
    bench.programs.remove(patient)  # It was told to die.
    return Verdict(", ".join(wrong) or "no core file, not dumpable", not wrong)


ATTACKS = [Attack("core", "session keys in core files", core_dumps)]
