"""The program as its users run it, and what each run costs."""
import os
import shutil
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

POVRAY = shutil.which(os.environ.get("PENUMBRA_POVRAY", "povray"))


@dataclass
class Ended:
    status: int = 0  # of exit; -signal when killed
    out: bytes = b""
    err: bytes = b""
    seconds: float = 0
    megabytes: float = 0  # most memory at once
    timed_out: bool = False

    def lines(self):
        return self.err.decode("utf-8", "replace").splitlines()


def run(words, folder=None, limit=10, environment=None):
    """Runs `words`; kills them after `limit` seconds."""
    variables = {**os.environ, "NO_COLOR": "1", **(environment or {})}
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begin = time.monotonic()
        # os.wait4() below tells what this process used; Popen.wait() would not.
        process = subprocess.Popen([str(word) for word in words], cwd=folder, stdout=out,
                                   stderr=err, stdin=subprocess.DEVNULL, env=variables)
        late = threading.Event()
        timer = threading.Timer(limit, lambda: (late.set(), process.kill()))
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - begin
        out.seek(0)
        err.seek(0)
        return Ended(process.returncode, out.read(), err.read(), seconds, usage.ru_maxrss / 1024,
                     late.is_set())


def is_sanitized(program):
    """Sanitizers take several times the time and the memory."""
    return b"__asan_init" in Path(program).read_bytes()


def content(folder):
    """Every file below `folder` by its path, with its bytes."""
    folder = Path(folder)
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}
