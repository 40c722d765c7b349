"""kill -9 at any moment leaves no damaged file: usage: kill_test.py PENUMBRA [--count N] [--seed S]

Each command is killed N times, at moments spread over a run's time, while it replaces the files of
an earlier run. Under every final name there must then be the earlier file or the new one, whole; the
next run must succeed and leave nothing else behind.
"""
import argparse
import json
import random
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from program import POVRAY, content, is_sanitized, run

LIMIT = 300


def write_scene(folder):
    """A surface of 20,000 facets with a texture: something to write, and something to render."""
    side = 100
    lines = ["mtllib wave.mtl", "usemtl wave"]
    for y in range(side + 1):
        for x in range(side + 1):
            lines.append(f"v {x / 10} {((x * 7 + y * 13) % 29) / 40} {y / 10}")
            lines.append(f"vt {x / side} {y / side}")
    for y in range(side):
        for x in range(side):
            a = y * (side + 1) + x + 1
            corners = (a, a + 1, a + side + 2, a + side + 1)
            lines.append("f " + " ".join(f"{v}/{v}" for v in corners))
    (folder / "wave.obj").write_text("\n".join(lines) + "\n")
    (folder / "wave.mtl").write_text("newmtl wave\nKs 0.4 0.4 0.4\nNs 40\nmap_Kd wave.ppm\n")
    noise = random.Random(1)
    texels = " ".join(str(noise.randrange(256)) for _ in range(128 * 128 * 3))
    (folder / "wave.ppm").write_text(f"P3 128 128 255\n{texels}\n")


class Command:
    """A command, where it writes, and what is right there."""

    def __init__(self, program, inputs, words, target):
        self.words = [program, words[0], str(inputs / "wave.obj"), "--quiet", *words[1:]]
        self.target = target  # name in the working folder
        self.old = self.new = None

    def prepare(self, folder):
        """Files of an earlier run with other settings, and of an undisturbed one."""
        self.run(folder, ["--set", "render.background=[0.2,0.4,0.6]", "--set",
                          "material.wave.diffuse=0.3"])
        self.old = content(folder)
        self.seconds = self.run(folder).seconds
        self.new = content(folder)
        assert self.old.keys() == self.new.keys() and self.old != self.new

    def run(self, folder, extra=()):
        ended = run([*self.words, *extra], folder, LIMIT)
        assert ended.status == 0, (ended.status, ended.err)
        return ended

    def restore(self, folder):
        for path in sorted(folder.rglob("*"), reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()
        for file, data in self.old.items():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            (folder / file).write_bytes(data)

    def is_whole(self, file, data):
        return data in (self.old[file], self.new[file]) or self.is_like(file, data)

    # Reports tell times, so that no two are the same.
    def is_like(self, file, data):
        if not self.target.endswith("report"):
            return False
        if file.endswith(".html"):
            return (data.startswith(b"<!DOCTYPE html>")
                    and data.endswith(b"</script>\n</body>\n</html>\n"))
        if file.endswith(".json"):
            return len(json.loads(data)["cases"]) == 1
        if file.endswith(".xml"):
            return ElementTree.fromstring(data).tag == "testsuites"
        return file.endswith("scene.pov") and self.without_command(data) in map(
            self.without_command, (self.old[file], self.new[file]))

    @staticmethod
    def without_command(data):
        return re.sub(rb"//   penumbra [^\n]*", b"", data)

    def kill_at(self, folder, seconds):
        """Whether the run was still going on."""
        with subprocess.Popen(self.words, cwd=folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            time.sleep(seconds)
            going_on = process.poll() is None
            process.kill()
        return going_on

    def check_after_kill(self, folder):
        """Names of what the killed run has left behind."""
        found = content(folder)
        for file in self.old:
            assert file in found, f"{file} is gone"
            assert self.is_whole(file, found[file]), f"{file} is damaged"
        return found.keys() - self.old.keys()

    def check_next_run(self, folder):
        self.run(folder)
        self.check_result(folder)

    def check_result(self, folder):
        found = content(folder)
        assert found.keys() == self.new.keys(), f"left behind: {found.keys() - self.new.keys()}"
        for file, data in found.items():
            same = data == self.new[file]
            assert same or self.is_like(file, data), f"{file} is not that of an undisturbed run"


class Render(Command):
    """What a run has rendered before it was killed is not rendered again with --resume."""

    def check_next_run(self, folder):
        self.run(folder, ["--resume"])
        self.check_result(folder)


def commands(program, inputs):
    # Checkpoints at so short a distance that most killed runs leave one.
    yield Render(program, inputs, ["render", "--size", "640x480", "--samples", "2", "-o", "out.png",
                                   "--checkpoint", "0.1"], "out.png")
    yield Command(program, inputs, ["export", "-o", "out.pov"], "out.pov")
    if POVRAY:
        yield Command(program, inputs, ["validate", "--size", "160x120", "--report", "report"],
                      "report")
    else:
        print("POV-Ray is not installed: validate is left out")


def kill_many(command, folder, count, moments):
    going_on = leftovers = 0
    for i in range(count):
        command.restore(folder)
        # One moment in each of as many equal parts of the time.
        moment = (i + moments.random()) / count * command.seconds
        going_on += command.kill_at(folder, moment)
        try:
            leftovers += bool(command.check_after_kill(folder))
            command.check_next_run(folder)
        except AssertionError as error:
            print(f"{command.words[1]} killed after {moment:.4f} s of {command.seconds:.4f}: "
                  f"{error}")
            return False
    print(f"{command.words[1]}: killed {count} times within {command.seconds:.2f} s, {going_on} times "
          f"before its end, {leftovers} times with something to clean up")
    return going_on > 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=lambda name: str(Path(name).absolute()))
    parser.add_argument("--count", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    good = True
    with tempfile.TemporaryDirectory() as name:
        inputs = Path(name) / "inputs"
        inputs.mkdir()
        write_scene(inputs)
        for command in commands(options.program, inputs):
            folder = Path(name) / command.words[1]
            folder.mkdir()
            command.prepare(folder)
            count = options.count // 3 + 1 if is_sanitized(options.program) else options.count
            good = kill_many(command, folder, count, random.Random(options.seed)) and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
