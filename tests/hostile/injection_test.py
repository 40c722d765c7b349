"""Names that are code stay text: usage: injection_test.py PENUMBRA

Every model exists twice, with harmless names and with names that are POV-Ray, shell, HTML, XML,
Markdown and terminal code. Whatever penumbra makes of both must differ in these names only.
"""
import json
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from pathlib import Path

import names
from program import POVRAY, content, is_sanitized, run

PROGRAM = str(Path(sys.argv.pop(1)).absolute())
LIMIT = 300 if is_sanitized(PROGRAM) else 60
MODELS = ["model.gltf", "model.obj", "studio.toml"]
# C0 without line ends, DEL, C1, marks of direction, line separators.
ACTIVE = re.compile("[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")


class Skeleton(HTMLParser):
    """What of a page is not text: elements, names of attributes, and values that do something."""

    def __init__(self, page):
        super().__init__()
        self.parts, self.inside = [], ""
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        active = {name: value for name, value in attrs
                  if name in ("style", "action", "http-equiv", "content", "class")
                  or name.startswith("on")}
        self.parts.append((tag, tuple(name for name, _ in attrs), tuple(active.items())))
        for name, value in attrs:
            # A report leads to its own files only.
            if name in ("href", "src") and not re.match(r"\./|\.\./|#|data:(image/png;|,)|\.\.$",
                                                        value):
                raise ValueError(f"{tag} leads to {value}")
        self.inside = tag

    def handle_endtag(self, tag):
        self.parts.append(("/", tag))
        self.inside = ""

    def handle_data(self, data):
        if self.inside in ("script", "style"):
            self.parts.append(data)

    def handle_comment(self, data):
        self.parts.append(("comment", data))

    def handle_decl(self, decl):
        self.parts.append(("declaration", decl))

    def unknown_decl(self, data):
        self.parts.append(("declaration", data))

    def handle_pi(self, data):
        self.parts.append(("instruction", data))


def shape(value):
    """A JSON value without its texts."""
    if isinstance(value, dict):
        return {key: shape(one) for key, one in value.items() if key != "seconds"}
    if isinstance(value, list):
        return [shape(one) for one in value]
    return "" if isinstance(value, str) else value


def elements(tree):
    return [(element.tag, sorted(element.keys())) for element in tree.iter()]


def code(text):
    """A POV-Ray file without comments, what its identifiers and files are called, and its identity.

    The identity is a hash over the whole file, names in comments included.
    """
    text = re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r"(Content_\w+ !?= )\d+", r"\1identity", text)
    text = re.sub(r"\b(Material|Mesh|Model)_[A-Za-z0-9_]+", r"\1_name", text)
    text = re.sub(r'"(\w+_textures/)\w+(\.png|\.exr)"', r'"\1name\2"', text)
    return re.sub(r"\s+", " ", text)


def pixels(png):
    """The chunks that tell what is seen, and not when it was made."""
    at, found = 8, []
    while at < len(png):
        size = int.from_bytes(png[at:at + 4], "big")
        if png[at + 4:at + 8] in (b"IHDR", b"IDAT"):
            found.append(png[at + 4:at + 8 + size])
        at += 12 + size
    return found


class Injection(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.top = Path(cls.scratch.name)
        cls.canary = cls.top / "CANARY"
        evil = names.payloads(cls.canary)
        names.write(cls.top / "evil", evil)
        names.write(cls.top / "good", [f"name{i}" for i in range(len(evil))])

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def tearDown(self):
        created = [path for path in self.top.rglob("*") if re.match("CANARY(?!_)", path.name)]
        self.assertEqual(created, [], "code of a name has run")

    def penumbra(self, which, *words, status=0):
        """Runs it in the folder of the evil or the good models; what it prints must be inert."""
        ended = run([PROGRAM, *words], self.top / which, LIMIT)
        self.assertEqual(ended.status, status, ended.err.decode("utf-8", "replace")[:2000])
        for stream in (ended.out, ended.err):
            found = ACTIVE.search(stream.decode("utf-8"))  # strictly: nothing else is printed
            self.assertIsNone(found, f"{words} print {found}")
        return ended

    def both(self, *words):
        return self.penumbra("evil", *words), self.penumbra("good", *words)

    def same_lines(self, evil, good):
        """As many lines of the same kind: no name has made one."""
        start = lambda text: [line[:5] for line in text.decode().split("\n")]
        self.assertEqual(start(evil.out), start(good.out))
        prefix = lambda text: {line.split(":")[0] for line in text.decode().splitlines()}
        self.assertEqual(prefix(evil.err), prefix(good.err))

    def test_info(self):
        for model in MODELS:
            with self.subTest(model):
                self.same_lines(*self.both("info", model))
                evil, good = self.both("info", model, "--json")
                self.assertEqual(shape(json.loads(evil.out)).keys(),
                                 shape(json.loads(good.out)).keys())

    def test_json_keeps_names(self):
        found = json.loads(self.penumbra("evil", "info", "model.gltf", "--json").out)
        self.assertIn("\n#fopen F \"" + str(self.canary), "".join(found["extensions"]))
        self.assertIn("\x1b[2J", "".join(found["extensions"]) + "\x1b[2J")

    def test_render(self):
        for model in MODELS:
            with self.subTest(model):
                self.same_lines(*self.both("render", model, "--size", "80x60", "-o", "out.png",
                                           "--verbose", "--json"))
                evil, good = (content(self.top / which)["out.png"] for which in ("evil", "good"))
                self.assertEqual(evil, good)

    def test_names_in_messages(self):
        for words in (["--camera", "\x1b[2J\u009b\u202e\n"], ["--variant", "\x1b[2J\u009b"],
                      ["--scene", "\u202e\x07"], ["--set", "camera.name='\x7f'"],
                      ["--animation", "\n"]):
            for model in ("model.gltf", "nothing\x1b[2J\u009b\n.gltf"):
                ended = run([PROGRAM, "info", model, *words], self.top / "evil", LIMIT)
                self.assertIn(ended.status, (2, 3), words)
                self.assertIsNone(ACTIVE.search(ended.err.decode("utf-8")), ended.err)
                self.assertEqual(len(ended.lines()), 1, ended.err)

    def exported(self, style, extension, then):
        for model in MODELS:
            with self.subTest(model):
                self.both("export", model, "--pov-style", style, "-o", f"scene.{extension}")
                evil, good = (content(self.top / which) for which in ("evil", "good"))
                for file in sorted(evil):
                    self.assertRegex(file, r"^[\w./-]+$")
                    if re.search(r"\.(pov|inc)$", file):
                        text = evil[file].decode("ascii")
                        self.assertNotRegex(text, r"[^\n -~]")
                        self.assertEqual(code(text), code(good[file].decode()), file)
                self.assertEqual(evil.get("scene.ini"), good.get("scene.ini"))
                self.assertEqual(len([file for file in evil if "textures" in file]),
                                 len([file for file in good if "textures" in file]))
                if POVRAY:
                    then()

    def povray(self, *words):
        pictures = []
        for which in ("evil", "good"):
            ended = run([POVRAY, *words, "-D", "+W64", "+H48"], self.top / which, LIMIT)
            self.assertEqual(ended.status, 0, ended.err.decode("latin-1")[-2000:])
            pictures.append((self.top / which / "picture.png").read_bytes())
        self.assertEqual(*map(pixels, pictures))

    def test_export(self):
        self.exported("standalone", "pov", lambda: self.povray("scene.ini", "+Opicture.png", "+FN"))

    def test_export_include(self):
        def include():
            for which in ("evil", "good"):
                folder = self.top / which
                (folder / "own.pov").write_text(
                    '#version 3.7; global_settings { assumed_gamma 1 }\n#include "scene.inc"\n'
                    "camera { location <0, 0, -40> look_at 0 } light_source { <0, 9, -40>, 1 }\n"
                    "object { Model_scene }\n")
            self.povray("+Iown.pov", "+Opicture.png", "+FN")

        self.exported("include", "inc", include)

    @unittest.skipUnless(POVRAY, "POV-Ray is not installed")
    def test_validate(self):
        for model in MODELS:
            with self.subTest(model):
                self.same_lines(*self.both("validate", model, "--size", "64x48", "--report", "r"))
                self.compare_reports()
                evil, good = self.both("validate", model, "--size", "64x48", "--report", "r",
                                       "--summary", "markdown")
                self.assertEqual(*(re.sub(rb"[^|\n]+", b"", end.out) for end in (evil, good)))

    def compare_reports(self):
        evil, good = (content(self.top / which / "r") for which in ("evil", "good"))
        self.assertEqual([file for file in evil if "texture" not in file],
                         [file for file in good if "texture" not in file])
        for file, data in evil.items():
            if file.endswith(".html"):
                self.assertEqual(Skeleton(data.decode()).parts, Skeleton(good[file].decode()).parts)
        junit = [elements(ElementTree.fromstring(one["junit.xml"])) for one in (evil, good)]
        self.assertEqual(*junit)
        report = [shape(json.loads(one["report.json"])) for one in (evil, good)]
        self.assertEqual(*report)

    def inputs(self):
        folder = self.top / "files"
        folder.mkdir(exist_ok=True)
        model = names.gltf(["a"] * 48)
        chosen = names.file_names()
        for name in chosen:
            (folder / f"{name}.gltf").write_bytes(model)
        return folder, [f"./{name}.gltf" for name in chosen]

    def test_file_names(self):
        folder, inputs = self.inputs()
        before = set(self.top.iterdir())
        for name in inputs:
            with self.subTest(name):
                for words in (["info", name], ["info", "--json", name],
                              ["export", name, "--size", "8x6"],
                              ["info", "--", name.removeprefix("./")]):
                    ended = self.penumbra("files", *words)
                    if "--json" not in words:
                        self.assertNotIn(b"\nEverything is rendered and exported exactly.\n(",
                                         ended.out)
        self.assertEqual(before, set(self.top.iterdir()), "something was written elsewhere")
        for file in content(folder):
            if not file.endswith((".gltf", ".pov", ".ini")):
                self.assertRegex(file, r"^[\w.-]+(_textures)?(/[\w.-]+)?$")
            if file.endswith(".ini"):
                self.assertNotIn("CANARY\n", (folder / file).read_text())

    @unittest.skipUnless(POVRAY, "POV-Ray is not installed")
    def test_file_names_in_reports(self):
        folder, inputs = self.inputs()
        chosen = inputs[::6] + inputs[-2:]
        before = set(self.top.iterdir())
        self.penumbra("files", "validate", "--each", *chosen, "--size", "16x12", "--report", "r",
                      "--jobs", "2")
        self.assertEqual(before, set(self.top.iterdir()), "something was written elsewhere")
        report = json.loads((folder / "r/report.json").read_bytes())
        self.assertEqual(len(report["cases"]), len(chosen))
        suite = ElementTree.parse(folder / "r/junit.xml")
        self.assertEqual(len(list(suite.iter("testcase"))), len(chosen))
        index = Skeleton((folder / "r/index.html").read_text(encoding="utf-8")).parts
        self.assertFalse([part for part in index
                          if part[0] in ("comment", "instruction", "iframe")])
        pages = {json.dumps(Skeleton(page.read_text(encoding="utf-8")).parts)
                 for page in (folder / "r").glob("*/index.html")}
        self.assertEqual(len(pages), 1, "a name has changed what a page is made of")


if __name__ == "__main__":
    unittest.main()
