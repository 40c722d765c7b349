"""Runs the renderers on a scene and measures each as a whole process."""

import json
import os
import shutil
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Run:
    """One run of one program: seconds and bytes as the kernel counted them."""
    cpu: float
    wall: float
    memory: int
    output: dict = field(default_factory=dict)  # what the program said of itself


def run(command, cpus, folder):
    """Runs a command on the given processors. Its standard output may be a JSON document."""
    before = os.sched_getaffinity(0)
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        os.sched_setaffinity(0, cpus)  # the child inherits it
        try:
            start = time.perf_counter()
            process = subprocess.Popen([str(word) for word in command], stdout=out, stderr=err,
                                       cwd=folder)
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.perf_counter() - start
            process.returncode = os.waitstatus_to_exitcode(status)
        finally:
            os.sched_setaffinity(0, before)
        out.seek(0)
        err.seek(0)
        if process.returncode != 0:
            raise SystemExit(f"{' '.join(map(str, command))}: exit {process.returncode}\n"
                             + err.read().decode(errors="replace"))
        text = out.read()
    return Run(usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss * 1024,
               json.loads(text) if text.startswith(b"{") else {})


@dataclass
class Tools:
    penumbra: Path
    floor: Path
    povray = shutil.which("povray")
    tachyon = shutil.which("tachyon")


@dataclass
class Case:
    """A scene at a size, with the files that the other renderers read."""
    name: str
    scene: Path
    size: tuple
    folder: Path
    settings: tuple = ()

    def set_options(self):
        return [w for s in self.settings for w in ("--set", s)]

    def prepare(self, tools):
        self.folder.mkdir(parents=True, exist_ok=True)
        size = f"{self.size[0]}x{self.size[1]}"
        quietly = {"check": True, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        for program, file in ((tools.povray, "scene.pov"), (tools.tachyon, "scene.dat")):
            if program:
                subprocess.run([tools.penumbra, "export", self.scene, "--size", size,
                                "--samples", "1", "-o", self.folder / file], **quietly)

    def command(self, tools, program, threads):
        size = f"{self.size[0]}x{self.size[1]}"
        return {
            "penumbra": [tools.penumbra, "render", self.scene, "--size", size, "--samples", "1",
                         "--threads", threads, *self.set_options(), "--json", "-o", self.folder / "penumbra.png"],
            "POV-Ray": [tools.povray, "scene.ini", f"+WT{threads}", "+FN8", "+Opovray.png", "-V"],
            "Tachyon": [tools.tachyon, "scene.dat", "-fullshade", "-shade_phong", "-numthreads",
                        threads, "-format", "PNG", "-o", "tachyon.png"],
            "floor": [tools.floor, self.scene, "--threads", threads, *self.set_options(), "--set",
                      f"render.size=[{self.size[0]},{self.size[1]}]"],
        }[program]

    def measure(self, tools, programs, cpus, repeat):
        """The runs of each program, taken in turn: a change of the machine's speed meets all."""
        runs = {program: [] for program in programs}
        for _ in range(repeat):
            for program in programs:
                command = self.command(tools, program, len(cpus))
                runs[program].append(run(command, cpus, self.folder))
        return runs

    def parity(self, tools):
        """The share of pixels that are the same in penumbra's and POV-Ray's last picture."""
        pictures = [self.folder / "penumbra.png", self.folder / "povray.png"]
        done = subprocess.run([tools.penumbra, "compare", *pictures, "--json"],
                              capture_output=True, check=False)
        return json.loads(done.stdout)["cases"][0]["metrics"]["parity"]["value"]
