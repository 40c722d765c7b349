"""What load costs: usage: load.py PENUMBRA [FOLDER]

8 commands at once, 1,000 models in one batch, and a model of 4 million facets, each measured and run
by hand; FOLDER (out/load) gets the files.
"""
import json
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import names
from program import POVRAY, run

LIMIT = 3600


def show(what, ended):
    print(f"{what}: exit {ended.status}, {ended.seconds:.1f} s, {ended.megabytes:.0f} MB")


def write_surface(file, side):
    """2 x side x side facets."""
    with open(file, "w", encoding="ascii") as out:
        for y in range(side + 1):
            out.writelines(f"v {x} {(x * 7 + y * 13) % 29 * 0.05} {y}\n" for x in range(side + 1))
        for y in range(side):
            row = y * (side + 1)
            out.writelines(f"f {row + x + 1} {row + x + 2} {row + x + side + 3} {row + x + side + 2}\n"
                           for x in range(side))


def eight_at_once(program, folder):
    write_surface(folder / "surface.obj", 300)
    words = [program, "render", "surface.obj", "--size", "800x600", "--samples", "2"]
    alone = run([*words, "-o", "alone.png"], folder, LIMIT)
    show("render of 180,000 facets, alone", alone)
    begin = time.monotonic()
    with ThreadPoolExecutor(8) as pool:
        runs = list(pool.map(lambda i: run([*words, "-o", f"{i}.png"], folder, LIMIT), range(8)))
    seconds = time.monotonic() - begin
    same = all((folder / f"{i}.png").read_bytes() == (folder / "alone.png").read_bytes()
               for i in range(8))
    print(f"8 of them at once: {seconds:.1f} s together, at most {max(r.megabytes for r in runs):.0f} "
          f"MB each, exit {set(r.status for r in runs)}, same bytes: {same}")


def thousand_models(program, folder):
    models = folder / "models"
    models.mkdir(exist_ok=True)
    for i in range(1000):
        (models / f"{i}.gltf").write_bytes(names.gltf([f"name {i} {j}" for j in range(12)]))
    files = [f"models/{i}.gltf" for i in range(1000)]
    begin = time.monotonic()
    ended = [run([program, "info", "--json", file], folder, LIMIT) for file in files]
    print(f"info of 1,000 models, one after the other: {time.monotonic() - begin:.1f} s, "
          f"exit {set(one.status for one in ended)}")
    if POVRAY:
        ended = run([program, "validate", "--each", *files, "--size", "32x24", "--jobs", "2",
                     "--report", "report", "--json"], folder, LIMIT)
        show("validate --each of 1,000 models", ended)
        verdicts = [case["verdict"] for case in json.loads(ended.out)["cases"]]
        print({verdict: verdicts.count(verdict) for verdict in set(verdicts)})


def four_million_facets(program, folder):
    write_surface(folder / "large.obj", 1415)
    print(f"OBJ of {2 * 1415 * 1415} facets, {(folder / 'large.obj').stat().st_size >> 20} MB")
    show("info", run([program, "info", "large.obj"], folder, LIMIT))
    show("render", run([program, "render", "large.obj", "-o", "large.png"], folder, LIMIT))
    show("export", run([program, "export", "large.obj", "-o", "large.pov"], folder, LIMIT))


def main():
    program = Path(sys.argv[1]).absolute()
    folder = Path(sys.argv[2] if len(sys.argv) > 2 else "out/load")
    folder.mkdir(parents=True, exist_ok=True)
    for measure in (eight_at_once, thousand_models, four_million_facets):
        measure(program, folder)


if __name__ == "__main__":
    main()
