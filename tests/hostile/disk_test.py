"""A full disk and a vanished folder: usage: disk_test.py PENUMBRA

Exit status 4, what was there is as it was, and nothing is left over.
"""
import ctypes
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from program import POVRAY, content, is_sanitized, run

PROGRAM = str(Path(sys.argv[1]).absolute())
LIMIT = 300 if is_sanitized(PROGRAM) else 60
LIBC = ctypes.CDLL(None, use_errno=True)

SCENE = """
[render]
size = [800, 600]
[camera]
position = [0, 3, 8]
look_at = [0, 0, 0]
[[plane]]
material = "noisy"
[material.noisy]
noise = { colors = [[0.9, 0.2, 0.1], [0.1, 0.3, 0.9]], size = 0.01 }
"""


# What was there, with the mark of an export: files of others are not replaced.
OLD = "what was there, written by penumbra"


def mount(folder):
    return LIBC.mount(b"tmpfs", os.fsencode(folder), b"tmpfs", 0, b"size=1m") == 0


def unmount(folder):
    LIBC.umount2(os.fsencode(folder), 2)  # MNT_DETACH


def write_model(folder):
    """30,000 facets, whose export has more than a megabyte."""
    noise = random.Random(1)
    lines = [f"v {noise.random()} {noise.random()} {noise.random()}" for _ in range(90000)]
    lines += [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(30000)]
    (folder / "soup.obj").write_text("\n".join(lines) + "\n")
    (folder / "noise.toml").write_text(SCENE)


class Disk(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.top = Path(cls.scratch.name)
        cls.disk = cls.top / "disk"
        write_model(cls.top)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def setUp(self):
        self.disk.mkdir()
        self.assertTrue(mount(self.disk))

    def tearDown(self):
        unmount(self.disk)
        shutil.rmtree(self.disk)

    def penumbra(self, *words):
        return run([PROGRAM, *words], self.top, LIMIT)

    def fails(self, *words, place):
        """The disk is afterwards as it was before."""
        before = content(self.disk)
        free = os.statvfs(self.disk).f_bfree
        ended = self.penumbra(*words)
        self.assertEqual(ended.status, 4, ended.err)
        self.assertEqual(len(ended.lines()), 1, ended.err)
        # libtiff does not say why.
        self.assertRegex(ended.lines()[0],
                         f"^penumbra: error: {place}: .*([Nn]o space left|TIFFWrite)")
        self.assertEqual(content(self.disk), before)
        self.assertEqual(os.statvfs(self.disk).f_bfree, free)
        self.assertEqual([path for path in self.disk.rglob("*") if path.is_dir()], [])

    def old(self, *files):
        for file in files:
            (self.disk / file).write_text(OLD)

    def test_render(self):
        for extension in ("png", "exr", "tif", "hdr", "jpg"):
            with self.subTest(extension):
                self.old(f"out.{extension}")
                if extension == "jpg":  # which is small
                    (self.disk / "filler").write_bytes(bytes(1000 << 10))
                words = ["--depth", "16"] if extension in ("png", "tif") else []
                self.fails("render", "noise.toml", "-o", f"disk/out.{extension}", *words,
                           place=f"disk/out.{extension}")

    def test_render_with_checkpoints(self):
        """A checkpoint that was worth its time stays, and that is said."""
        self.old("out.exr")
        ended = self.penumbra("render", "noise.toml", "-o", "disk/out.exr", "--checkpoint", "0.05",
                              "--size", "1600x1200")
        self.assertEqual(ended.status, 4, ended.err)
        self.assertEqual(len(ended.lines()), 1, ended.err)
        self.assertRegex(ended.lines()[0], "^penumbra: error: disk/out.exr: .*[Nn]o space left")
        found = content(self.disk)
        kept = found.pop("out.exr.checkpoint", None) is not None
        self.assertEqual(found, {"out.exr": OLD.encode()})
        self.assertEqual(ended.lines()[0].endswith("--resume goes on from its checkpoint"), kept)

    def test_export(self):
        self.old("out.pov", "out.ini", "out_geometry.inc")
        ended = self.penumbra("export", "soup.obj", "-o", "disk/out.pov")
        self.assertEqual(ended.status, 4, ended.err)
        found = content(self.disk)
        # The .pov, which needs the others, comes last; the .ini is small and may be new.
        self.assertEqual(found.keys(), {"out.pov", "out.ini", "out_geometry.inc"})
        for file in ("out.pov", "out_geometry.inc"):
            self.assertEqual(found[file], OLD.encode())
        self.assertIn(found["out.ini"][:5], (b"what ", b"; Run"))

    @unittest.skipUnless(POVRAY, "POV-Ray is not installed")
    def test_validate(self):
        # With geometry that does not fit, and with pictures that do not.
        for scene in ("soup.obj", "noise.toml"):
            with self.subTest(scene):
                (self.disk / "report").mkdir(exist_ok=True)
                (self.disk / "report/index.html").write_text(OLD)
                before = content(self.disk)
                ended = self.penumbra("validate", scene, "--report", "disk/report")
                self.assertEqual(ended.status, 4, ended.err)
                self.assertEqual(content(self.disk), before)

    @unittest.skipUnless(POVRAY, "POV-Ray is not installed")
    def test_validate_where_povray_fills_the_disk(self):
        (self.disk / "filler").write_bytes(bytes(600 << 10))
        before = content(self.disk)
        scene = self.top / "plain.toml"
        scene.write_text(SCENE.replace("noise = {", "checker = {").replace("0.01", "2"))
        ended = self.penumbra("validate", "plain.toml", "--report", "disk/report")
        self.assertEqual(ended.status, 4, ended.err)
        self.assertRegex(ended.lines()[-1], "[Nn]o space left")
        self.assertEqual(content(self.disk), before)

    def test_vanished_folder(self):
        """The folder is removed while the command is at work."""
        commands = [["render", "noise.toml", "--size", "2000x1500", "-o", "gone/out.png"],
                    ["export", "soup.obj", "-o", "gone/out.pov"]]
        if POVRAY:
            commands.append(["validate", "noise.toml", "--report", "gone/report"])
        for words in commands:
            with self.subTest(words[0]):
                gone = self.top / "gone"
                gone.mkdir()
                with subprocess.Popen([PROGRAM, *words], cwd=self.top, stderr=subprocess.PIPE,
                                      stdout=subprocess.DEVNULL) as process:
                    time.sleep(0.03)
                    shutil.rmtree(gone, ignore_errors=True)
                    error = process.stderr.read().decode()
                shutil.rmtree(gone, ignore_errors=True)
                self.assertEqual(process.returncode, 4, error)
                self.assertEqual(len(error.splitlines()), 1, error)

    def test_folder_that_is_not_there(self):
        for words in (["render", "noise.toml", "-o", "none/out.png"],
                      ["export", "soup.obj", "-o", "none/out.pov"],
                      ["validate", "noise.toml", "--report", "none/report"]):
            ended = self.penumbra(*words)
            self.assertEqual(ended.status, 4, ended.err)
            self.assertIn("its folder does not exist", ended.lines()[-1])


def main():
    with tempfile.TemporaryDirectory() as name:
        if mount(name):
            unmount(name)
            return unittest.main(argv=sys.argv[:1])
    # Who is not root may be so in a namespace of their own.
    if "--inside" not in sys.argv and shutil.which("unshare"):
        words = ["unshare", "-rm", sys.executable, __file__, PROGRAM, "--inside"]
        trial = subprocess.run(["unshare", "-rm", "true"], capture_output=True, check=False)
        if trial.returncode == 0:
            return subprocess.run(words, check=False).returncode
    print("SKIPPED: no file system can be mounted here")
    return 0


if __name__ == "__main__":
    sys.exit(main())
