"""report.json obeys its published schema, and junit.xml is what CI systems read.

usage: report_documents.py PENUMBRA SCHEMA
"""
import copy
import json
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

try:
    import jsonschema
except ImportError:
    print("SKIPPED: python3-jsonschema is not installed")
    sys.exit(0)


def picture(width, height, level):
    values = (f"{(x * 7 + y * 13) % 200 * level // 100}" for y in range(height)
              for x in range(width) for _ in range(3))
    return f"P3 {width} {height} 255\n" + "\n".join(values) + "\n"


def make(folder):
    """Pairs that pass, fail, cannot be compared and lack a counterpart."""
    cases = {"same": (picture(40, 30, 100), picture(40, 30, 100)),
             "darker": (picture(40, 30, 100), picture(40, 30, 70)),
             "size": (picture(40, 30, 100), picture(40, 20, 100)),
             "<&\"alone>": (picture(8, 8, 100), None)}
    for side in (0, 1):
        (folder / str(side)).mkdir()
        for name, texts in cases.items():
            if texts[side]:
                (folder / str(side) / f"{name}.ppm").write_text(texts[side])


def main():
    program, schema_file = sys.argv[1:]
    schema = json.loads(Path(schema_file).read_text())
    validator = jsonschema.Draft202012Validator
    validator.check_schema(schema)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        make(folder)
        done = subprocess.run([program, "compare", "0", "1", "--report", "r", "--json"],
                              cwd=folder, capture_output=True, text=True, check=False)
        document = json.loads(done.stdout)
        assert document == json.loads((folder / "r/report.json").read_text())
        suite = ElementTree.parse(folder / "r/junit.xml").getroot()
    validator(schema).validate(document)

    verdicts = {case["name"]: case["verdict"] for case in document["cases"]}
    assert verdicts == {"same.ppm": "pass", "darker.ppm": "fail", "size.ppm": "not_comparable",
                        "<&\"alone>.ppm": "error"}, verdicts

    same = [case["name"] for case in document["cases"]].index("same.ppm")
    for path in (["cases", same, "verdict"], ["cases", same, "metrics", "flip", "ok"], ["version"]):
        broken = copy.deepcopy(document)
        at = broken
        for key in path[:-1]:
            at = at[key]
        at[path[-1]] = "nonsense"
        assert list(validator(schema).iter_errors(broken)), f"the schema accepts {path}"

    tests = {case.get("name"): case for case in suite.iter("testcase")}
    assert set(tests) == set(verdicts), set(tests)
    assert suite.get("tests") == "4" and suite.get("errors") == "1", suite.attrib
    assert suite.get("failures") == "2", suite.attrib
    assert tests["darker.ppm"].find("failure") is not None
    assert tests["<&\"alone>.ppm"].find("error") is not None
    assert len(list(tests["same.ppm"])) == 1  # the figures


main()
