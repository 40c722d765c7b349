"""Every bad model of the asset folder: no crash, a bounded cost, the right exit code, a clear message.

usage: table.py PENUMBRA [--write]

expected.tsv has a line for each of them: file, exit status of `penumbra info`, and what it says, which
is the error, or the first loss and how many more there are. With --write it is written anew, to be
reviewed, by a program without sanitizers; else every difference is a failure.
"""
import json
import os
import re
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from program import is_sanitized, run

SECONDS, MEGABYTES = 10, 1024
ALLOWED = {"must-reject": {3}, "invalid": {0, 3}, "invalid-unsafe": {0, 3},
           "load-or-refuse": {0, 3}, "load": {0}, "load-with-warnings": {0}}
# What libraries say of a file that they cannot read differs from version to version.
FOREIGN = re.compile(r"(?<=cannot be read as an image )"
                     r"\((?!it is empty|it has|unknown format|the file is cut).*\)")
# What is wrong with the file changes nothing: it is in what nobody uses, or is as good as right.
NOTHING = "(nothing is lost)"
# Refused although their entry says that they load.
STRICTER = {
    "bad/synthetic/obj/only-comment.obj": "it has no facets",
    "bad/synthetic/obj/only-vertices.obj": "it has no facets",
    "bad/validator/base/data/asset/min_version_valid.gltf": "it asks for glTF 2.1",
    "bad/validator/base/data/buffer/non_relative_uri.gltf": "its buffer is on another machine",
    "bad/validator/base/data/root/unused_objects.gltf": "the buffer of its mesh has no content",
}


class Table:
    def __init__(self, program, assets):
        self.program, self.assets = program, assets
        self.sanitized = is_sanitized(program)
        self.most_seconds = self.most_megabytes = 0
        self.scratch = tempfile.TemporaryDirectory()

    def ended_well(self, ended, what, allowed):
        """The complaints that every run may give rise to."""
        self.most_seconds = max(self.most_seconds, ended.seconds)
        self.most_megabytes = max(self.most_megabytes, ended.megabytes)
        if ended.timed_out:
            yield f"{what} took more than {SECONDS} s"
        elif ended.status < 0:
            yield f"{what} was ended by signal {-ended.status}"
        elif ended.status not in allowed:
            yield f"{what} ended with {ended.status}, not {' or '.join(map(str, sorted(allowed)))}"
        if ended.megabytes > MEGABYTES and not self.sanitized:
            yield f"{what} took {ended.megabytes:.0f} MB"

    def try_one(self, asset, expected):
        """The line of the table, and what is wrong."""
        file = asset["file"]
        # What `info` does is a part of `render`, and sanitized programs are slow to start.
        if self.sanitized and expected.get(file, "").startswith(f"{file}\t0\t"):
            return expected[file], list(self.rendered(file))
        ended = run([self.program, "info", "--json", file], self.assets, self.limit())
        allowed = {3} if file in STRICTER else ALLOWED[asset["expect"]]
        problems = list(self.ended_well(ended, "info", allowed))
        said = ""
        if ended.status == 0:
            losses = json.loads(ended.out)["losses"]
            if losses:
                said = f"{losses[0]['place']}: {losses[0]['what']}"
                said += f" (+{len(losses) - 1})" if len(losses) > 1 else ""
            elif asset["expect"].startswith("invalid"):
                said = NOTHING
            problems += self.rendered(file)
        else:
            problems += self.one_error(ended, file)
            said = ended.lines()[0].removeprefix("penumbra: error: ") if ended.lines() else ""
        said = FOREIGN.sub("(...)", said.removeprefix(file))
        return f"{file}\t{ended.status}\t{said}", problems

    def limit(self):
        return SECONDS * (6 if self.sanitized else 1)

    @staticmethod
    def one_error(ended, file):
        lines = ended.lines()
        if len(lines) != 1:
            yield f"{len(lines)} lines on standard error: {lines[:3]}"
        elif not re.match(rf"penumbra: error: {re.escape(file)}(#|:\d+(:\d+)?: |: )\S", lines[0]):
            yield f"the error names no place: {lines[0]}"
        if ended.out:
            yield "there is a result on standard output"

    def rendered(self, file):
        picture = Path(self.scratch.name) / (re.sub(r"\W", "_", file) + ".png")
        ended = run([self.program, "render", file, "--size", "16x12", "-o", picture], self.assets,
                    self.limit())
        yield from self.ended_well(ended, "render", {0})
        for line in ended.lines():
            if not line.startswith("penumbra: warning: "):
                yield f"render says {line}"
        if ended.status == 0 and picture.stat().st_size < 60:
            yield "render leaves no picture"
        picture.unlink(missing_ok=True)


def by_file(lines):
    return {line.split("\t")[0]: line for line in lines}


def differences(before, now):
    """What changed, by file."""
    for file in sorted(before.keys() | now.keys()):
        if before.get(file) != now.get(file):
            yield file, f"expected: {before.get(file)}\n      is: {now.get(file)}"


def main():
    program, here = Path(sys.argv[1]).absolute(), Path(__file__).resolve().parent
    assets = Path(os.environ.get("PENUMBRA_ASSETS", here / "../../../shared/assets"))
    table_file = here / "expected.tsv"
    if not (assets / "MANIFEST.toml").exists():
        print("SKIPPED: the asset folder is not here")
        return 0
    with open(assets / "MANIFEST.toml", "rb") as file:
        bad = [asset for asset in tomllib.load(file)["asset"] if asset["kind"].startswith("bad-")]
    bad.sort(key=lambda asset: asset["file"])
    table = Table(program, assets)
    expected = by_file(table_file.read_text(encoding="utf-8").splitlines())
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda asset: table.try_one(asset, expected), bad))
    lines = [line for line, _ in results]
    failures = [(asset, problem) for asset, (_, problems) in zip(bad, results)
                for problem in problems]
    for asset, problem in failures:
        print(f"{asset['file']} ({asset['expect']}: {asset['see'][:100]})\n    {problem}")
    refused = sum(line.split("\t")[1] == "3" for line in lines)
    print(f"{len(bad)} files, {refused} refused; at most {table.most_seconds:.1f} s and "
          f"{table.most_megabytes:.0f} MB")
    if "--write" in sys.argv:
        table_file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return 0
    changes = list(differences(expected, by_file(lines)))
    for file, change in changes:
        print(f"{file}\n    {change}")
    return 1 if failures or changes else 0


if __name__ == "__main__":
    sys.exit(main())
