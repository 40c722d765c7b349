"""What was measured as Markdown."""

import math

MEGA = 1e6
KINDS = ("primary", "mirror", "shadow")


def best(runs, key=lambda run: run.cpu):
    """Other work on the machine only ever adds: the least of the runs counts."""
    return min(key(run) for run in runs)


def phase(runs, name):
    """Seconds of wall time that a program says a phase has taken: import, build or render."""
    return best(runs, lambda run: run.output["seconds"][name])


def render_phase(ours, floor):
    """Seconds of both from the search trees to the picture."""
    return phase(ours, "render"), phase(floor, "render")


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def number(value, digits=2):
    return "" if value is None else f"{value:.{digits}f}"


def megabytes(value):
    return f"{value / MEGA:.0f}"


def table(head, rows):
    lines = [head, ["---"] + ["--:"] * (len(head) - 1)] + rows
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def programs(results, peers):
    """CPU seconds and memory of all programs, a row for each scene."""
    head = ["scene", "penumbra, CPU s", "MB"]
    for peer in peers:
        head += [f"{peer}, CPU s", "MB", "times"]
    rows, ratios = [], {peer: [] for peer in [*peers, "floor"]}
    for name, runs in results.items():
        ours = best(runs["penumbra"])
        row = [name, number(ours), megabytes(best(runs["penumbra"], lambda r: r.memory))]
        for peer in peers:
            ratios[peer].append(best(runs[peer]) / ours)
            row += [number(best(runs[peer])), megabytes(best(runs[peer], lambda r: r.memory)),
                    f"**{number(ratios[peer][-1], 1)}**"]
        render, floor = render_phase(runs["penumbra"], runs["floor"])
        ratios["floor"].append(render / floor)
        rows.append(row + [number(render), number(floor), f"**{number(ratios['floor'][-1])}**"])
    mean = ["geometric mean", "", ""]
    for peer in peers:
        mean += ["", "", f"**{number(geometric_mean(ratios[peer]), 1)}**"]
    rows.append(mean + ["", "", f"**{number(geometric_mean(ratios['floor']))}**"])
    return table(head + ["render phase, s", "floor, s", "times"], rows)


def scenes(results, parity):
    """What each scene is, and whether penumbra and POV-Ray draw the same picture of it."""
    rows = []
    for name, runs in results.items():
        floor = runs["floor"][0].output
        counts = [number(floor["rays"][kind] / MEGA) for kind in KINDS]
        rows.append([name, f"{floor['facets']:,}", str(floor["sources"]), *counts,
                     number(parity.get(name), 6)])
    return table(["scene", "facets", "virtual sources", "primary rays, millions", "mirror rays",
                  "shadow rays", "parity with POV-Ray"], rows)


def rays(results):
    """Millions of rays a second on one core."""
    rows = []
    for name, runs in results.items():
        floors = [run.output for run in runs["floor"]]
        row = [name]
        for kind in KINDS:
            seconds = min(f["thread_seconds"][kind] for f in floors)
            count = floors[0]["rays"][kind]
            row.append(number(count / seconds / MEGA, 1) if count else "")
        total = sum(floors[0]["rays"][kind] for kind in KINDS)
        render, floor = render_phase(runs["penumbra"], runs["floor"])
        rows.append(row + [number(total / floor / MEGA, 1), number(total / render / MEGA, 1)])
    return table(["scene", "floor: primary", "mirror", "shadow", "all", "penumbra: all"], rows)


def threads(one, many, count):
    """How much faster the render phase is with more threads."""
    rows, gains = [], []
    for name, runs in one.items():
        before, after = (phase(r["penumbra"], "render") for r in (runs, many[name]))
        first, second = (phase(r["floor"], "render") for r in (runs, many[name]))
        gains.append(before / after)
        rows.append([name, number(before), number(after), f"**{number(gains[-1])}**",
                     number(first / second)])
    rows.append(["geometric mean", "", "", f"**{number(geometric_mean(gains))}**", ""])
    return table(["scene", "1 thread, s", f"{count} threads, s", "times", "floor, times"], rows)


def growth(what, results):
    """Render phase and memory against the number of something, on one core."""
    rows, first = [], None
    for count, runs in results.items():
        render, floor = render_phase(runs["penumbra"], runs["floor"])
        first = first or render
        rows.append([f"{count:,}", number(render, 3), number(render / first), number(floor, 3),
                     number(phase(runs["penumbra"], "import"), 3),
                     number(phase(runs["penumbra"], "build"), 3),
                     megabytes(best(runs["penumbra"], lambda r: r.memory))])
    return table([what, "render phase, s", "times the first", "floor, s", "import, s", "building, s", "MB"],
                 rows)
