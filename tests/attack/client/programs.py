"""The product's programs as processes on loopback, and what they said."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from client.dtls import Identity

Address = tuple[str, int]
SANITIZER = re.compile(r"ERROR: \w*Sanitizer|runtime error:|Sanitizer:DEADLYSIGNAL|PALP_CHECK")


def wait_for(condition: Callable[[], object], seconds: float) -> bool:
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.01)
    return True


class Program:
    """A running program. Its standard output and error go to one log."""

    def __init__(self, bench: Bench, name: str, arguments: list[str], **popen) -> None:
        count = len(bench.programs)
        self.log_path = bench.work / f"{count}-{name}.log"
        self.report_path = bench.work / f"{count}-{name}.json"
        with self.log_path.open("wb") as log:
            self.process = subprocess.Popen(
                [str(bench.bin / name), *arguments],
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                **popen,
            )
        bench.programs.append(self)

    @property
    def pid(self) -> int:
        return self.process.pid

    @property
    def log(self) -> str:
        return self.log_path.read_text(errors="replace")

    @property
    def running(self) -> bool:
        return self.process.poll() is None

    @property
    def report(self) -> dict:
        return json.loads(self.report_path.read_text()) if self.report_path.exists() else {}

    @property
    def crashed(self) -> str:
        """What a sanitizer or a signal said, or nothing."""
        if match := SANITIZER.search(self.log):
            return match.group()
        code = self.process.poll()
        ours = (-signal.SIGKILL, -signal.SIGTERM)
        return f"signal {-code}" if code is not None and code < 0 and code not in ours else ""

    def address(self) -> Address:
        found = re.compile(r"^listening on ([\d.]+):(\d+)", re.M)
        if not wait_for(lambda: found.search(self.log) or not self.running, 20):
            raise RuntimeError(f"{self.log_path.name} does not listen: {self.log}")
        match = found.search(self.log)
        if match is None:
            raise RuntimeError(f"{self.log_path.name} ended: {self.log}")
        return match.group(1), int(match.group(2))

    def count(self, words: str) -> int:
        return self.log.count(words)

    def resident_kb(self) -> int:
        status = Path(f"/proc/{self.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1))

    def finish(self, seconds: float = 20, ask: bool = True) -> int | None:
        """The exit code; `ask`: by SIGINT. None: it had to be killed."""
        if ask and self.running:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None


class Bench:
    """A folder of an attack's own, keys for both sites, all programs started; gone at its end."""

    def __init__(
        self, binaries: Path, seconds: float, seed: int, count: int | None = None
    ) -> None:
        """`count`: so many lies, however long they take, instead of `seconds`."""
        self.bin, self.seed, self.count = binaries, seed, count
        self.seconds = seconds if count is None else 3600.0
        self.work = Path(tempfile.mkdtemp(prefix="palp-attack-"))
        self.programs: list[Program] = []

    def __enter__(self) -> Bench:
        return self

    def __exit__(self, *_) -> None:
        for program in self.programs:
            if program.running:
                program.process.kill()
                program.process.wait()
        if not os.environ.get("PALP_KEEP"):
            shutil.rmtree(self.work, ignore_errors=True)

    @property
    def sanitized(self) -> bool:
        """Then memory and time say nothing."""
        return b"__asan_init" in (self.bin / "palp-patient").read_bytes()

    def memory_is_kept(self, grown_kb: int, limit_kb: int = 4096) -> bool:
        return self.sanitized or grown_kb < limit_kb

    @property
    def keys(self) -> Path:
        return self.make_keys("keys")

    def make_keys(self, name: str) -> Path:
        folder = self.work / name
        if not folder.exists():
            command = [self.bin / "palp-surgeon", "certificates", "--folder", folder]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return folder

    def identity(self, role: str) -> Identity:
        return Identity.of(self.keys / role)

    def start(self, name: str, *arguments: object, **popen) -> Program:
        return Program(self, name, [str(a) for a in arguments], **popen)

    def patient(self, *arguments: object, **popen) -> Program:
        report = self.work / f"{len(self.programs)}-palp-patient.json"
        return self.start(
            "palp-patient", "--listen", "127.0.0.1:0", "--identity", self.keys / "patient",
            "--report", report, *arguments, **popen,
        )  # fmt: skip

    def surgeon(self, peer: Address, *arguments: object, **popen) -> Program:
        report = self.work / f"{len(self.programs)}-palp-surgeon.json"
        return self.start(
            "palp-surgeon", "--peer", f"{peer[0]}:{peer[1]}", "--identity", self.keys / "surgeon",
            "--report", report, *arguments, **popen,
        )  # fmt: skip

    def script(self, *lines: str) -> str:
        """As a `--master`."""
        path = self.work / f"script-{len(self.programs)}.txt"
        path.write_text("\n".join(lines) + "\n")
        return f"script:{path}"

    def crashes(self) -> str:
        told = (f"{p.log_path.stem} {p.crashed}" for p in self.programs if p.crashed)
        return ", ".join(told)
