#!/usr/bin/env python3
"""Sweeps the numbers of tuning.rs over random scenes: python3 docs/sweep.py [NUMBER ...]

Builds a copy of the last commit whose numbers come from the environment. Halves and doubles each
number, and counts the scenes that hold. Angles are halved and doubled, not their cosines. Writes
docs/data/tuning.csv and a table of measurements.md. Takes half an hour on two cores. With names of
numbers as arguments, keeps the rows of the others.
"""
import csv
import datetime
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).parent
SOURCE = "crates/rapier-integration/src/pair"
SEEDS = ["301", "302"]
FACTORS = [0.5, 2.0]
NUMBER = re.compile(r"^(?:pub\(super\) )?const (\w+): (Real|f64) = ([^;]+);", re.M)


def read_numbers(text):
    """Type, value, and whether it is a cosine, of each public number by its name."""
    shared, numbers, angles_end = {}, {}, text.index("// Lengths")
    for match in NUMBER.finditer(text):
        name, kind, value = match.groups()
        value = eval(value.replace(" as Real", ""), {}, shared)
        shared[name] = value
        if match[0].startswith("pub"):
            numbers[name] = kind, value, match.start() < angles_end
    return numbers


def scaled(value, is_cosine, factor):
    if is_cosine:
        return math.cos(factor * math.acos(value))
    # A ratio of two lengths scales by its excess.
    return 1 + factor * (value - 1) if 1 < value < 2 else factor * value


def tunable(copy):
    """Turns the numbers of a copy of the project into variables. Returns what they are."""
    path = copy / SOURCE / "tuning.rs"
    text = path.read_text()
    numbers = read_numbers(text)
    statics = [f'pub(super) static {name}: std::sync::LazyLock<{kind}> = std::sync::LazyLock::new(|| '
               f'std::env::var("{name}").map_or({value!r}, |text| text.parse().unwrap()));'
               for name, (kind, value, _) in numbers.items()]
    path.write_text("use parry3d::math::Real;\n" + "\n".join(statics) + "\n")
    word = re.compile(r"\b(" + "|".join(numbers) + r")\b")
    for path in (copy / SOURCE).rglob("*.rs"):
        if path.name != "tuning.rs":
            parts = re.split(r"(^\s*(?:pub\S* )?use [^;]*;|//.*$)", path.read_text(), flags=re.M)
            parts[::2] = [word.sub(r"(*\1)", part) for part in parts[::2]]
            path.write_text("".join(parts))
    return numbers


def held(binary, numbers, copy):
    """Scenes that hold, by family."""
    counts, file = {}, copy / "scenes.csv"
    for seed in SEEDS:
        command = [binary, "--random", "60", "--seed", seed, "--backends", "sbbk", "--csv", file]
        subprocess.run(command, env=os.environ | numbers, check=True, capture_output=True)
        for row in csv.reader(file.open()):
            if len(row) == 6 and row[1].startswith("family ") and row[3] in ("held", "scenes"):
                counts[row[1], row[3]] = counts.get((row[1], row[3]), 0) + int(row[5])
    total = lambda what: sum(count for (_, kind), count in counts.items() if kind == what)
    return total("held"), total("scenes")


def known_rows(names):
    """Rows of the last sweep, by the names of their numbers."""
    rows = csv.reader((DOCS / "data/tuning.csv").open())
    return {row[0]: (row[0], *map(float, row[1:4]), *map(int, row[4:])) for row in rows if row[0] in names}


def write_table(rows, scenes, base):
    head = ("| number | half | as it is | double | scenes that hold: half | double |\n"
            "|---|---:|---:|---:|---:|---:|\n")
    body = "".join(f"| `{name}` | {low:.3g} | {value:.3g} | {high:.3g} | {at_low} | {at_high} |\n"
                   for name, low, value, high, at_low, at_high in rows)
    page = DOCS / "measurements.md"
    text = re.sub(r"(<!-- table: tuning -->\n).*?(<!-- end -->)", lambda m: m[1] + head + body + m[2],
                  page.read_text(), flags=re.S)
    page.write_text(text)
    print(f"{base} of {scenes} scenes hold with the numbers as they are")


def main():
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "copy"
        subprocess.run(["git", "clone", "-q", DOCS.parent, copy], check=True)
        commit = subprocess.check_output(["git", "rev-parse", "--short=8", "HEAD"], cwd=copy, text=True)
        numbers = tunable(copy)
        build = ["cargo", "build", "-q", "--release", "-p", "sbbk-lab", "--example", "hard_scenes"]
        quiet = os.environ | {"RUSTFLAGS": "-Awarnings"}
        subprocess.run(build, cwd=copy, check=True, env=quiet)
        binary = copy / "target/release/examples/hard_scenes"
        base, scenes = held(binary, {}, copy)
        if unknown := set(sys.argv[1:]) - set(numbers):
            sys.exit(f"tuning.rs has no {', '.join(sorted(unknown))}, but {', '.join(numbers)}")
        known = {} if len(sys.argv) == 1 else known_rows(set(numbers) - set(sys.argv[1:]))
        rows = []
        for index, (name, (_, value, is_cosine)) in enumerate(numbers.items()):
            print(f"{index + 1} of {len(numbers)}: {name}", file=sys.stderr, flush=True)
            if name in known:
                rows.append(known[name])
                continue
            low, high = [scaled(value, is_cosine, factor) for factor in FACTORS]
            counts = [held(binary, {name: repr(at)}, copy)[0] for at in (low, high)]
            rows.append((name, low, value, high, *counts))
    with (DOCS / "data/tuning.csv").open("w") as file:
        print(f"# {datetime.date.today()}, commit {commit.strip()}", file=file)
        print(f"# {base} of {scenes} scenes hold, seeds {' and '.join(SEEDS)}", file=file)
        csv.writer(file, lineterminator="\n").writerows(
            [("number", "half", "value", "double", "held_half", "held_double"), *rows])
    write_table(rows, scenes, base)


main()
