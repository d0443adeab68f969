"""Asks Coal and FCL what `examples/queries.rs --export DIR` asked stock Parry and SBBK."""

import argparse
import csv
import itertools
import math
import time
from pathlib import Path

import coal
import fcl
import numpy

ALL_CONTACTS = 1_000_000
# Answers that differ by less, in units, agree: poses are f32.
TOLERANCE = 1e-5


def read_obj(path):
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        kind, *numbers = line.split()
        if kind == "v":
            vertices.append([float(x) for x in numbers])
        else:
            triangles.append([int(i) - 1 for i in numbers])
    return numpy.array(vertices), numpy.array(triangles)


def rotation(x, y, z, w):
    n = math.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / n, y / n, z / n, w / n
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


class Coal:
    name = "coal"

    def __init__(self, vertices, triangles):
        self.mesh = coal.BVHModelOBBRSS()
        self.mesh.beginModel(len(triangles), len(vertices))
        self.mesh.addVertices(vertices)
        for triangle in triangles:
            corners = (vertices[i] for i in triangle)
            self.mesh.addTriangle(*corners)
        self.mesh.endModel()
        self.home = coal.Transform3s(numpy.eye(3), numpy.zeros(3))

    def place(self, rotation, translation):
        self.placed = coal.Transform3s(rotation, translation)

    def collide(self, count):
        request = coal.CollisionRequest()
        request.num_max_contacts = count
        request.enable_contact = count > 1
        result = coal.CollisionResult()
        coal.collide(self.mesh, self.home, self.mesh, self.placed, request, result)
        return result.numContacts()

    def distance(self):
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        return max(0.0, coal.distance(self.mesh, self.home, self.mesh, self.placed, request, result))


class Fcl:
    name = "fcl"

    def __init__(self, vertices, triangles):
        mesh = fcl.BVHModel()
        mesh.beginModel(len(vertices), len(triangles))
        mesh.addSubModel(vertices, triangles)
        mesh.endModel()
        self.pair = [fcl.CollisionObject(mesh, fcl.Transform()) for _ in range(2)]

    def place(self, rotation, translation):
        self.pair[1].setTransform(fcl.Transform(rotation, translation))

    def collide(self, count):
        request = fcl.CollisionRequest(num_max_contacts=count, enable_contact=count > 1)
        result = fcl.CollisionResult()
        fcl.collide(*self.pair, request, result)
        return len(result.contacts) if count > 1 else int(result.is_collision)

    def distance(self):
        request, result = fcl.DistanceRequest(), fcl.DistanceResult()
        return max(0.0, fcl.distance(*self.pair, request, result))


QUERIES = {
    "distance": lambda library: library.distance(),
    "intersection": lambda library: library.collide(1),
    "all contacts": lambda library: library.collide(ALL_CONTACTS),
}


def measure(library, ask, poses, repeats):
    """Least mean time over the poses in microseconds, and the answers."""
    best, answers = math.inf, []
    for _ in range(repeats):
        answers, total = [], 0.0
        for pose in poses:
            library.place(*pose)
            start = time.perf_counter()
            answers.append(ask(library))
            total += time.perf_counter() - start
        best = min(best, 1e6 * total / len(poses))
    return best, answers


def call_cost():
    """What a call costs that finds nothing."""
    triangle = numpy.eye(3), numpy.array([[0, 1, 2]])
    far = numpy.eye(3), numpy.array([100.0, 0.0, 0.0])
    costs = []
    for kind in (Coal, Fcl):
        cost, _ = measure(kind(*triangle), QUERIES["intersection"], [far] * 1000, 5)
        costs.append(f"{kind.name} {cost:.2f}")
    return ", ".join(costs)


def mean(ratios):
    return math.exp(sum(map(math.log, ratios)) / len(ratios))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="what the example exported")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    with open(arguments.folder / "queries.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["query"] in QUERIES]
    libraries, ratios = {}, {}
    print("| query | place | mesh | stock, µs | sbbk, µs | coal, µs | fcl, µs | better : sbbk | differ, coal | differ, fcl |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for (mesh, query, place), group in itertools.groupby(rows, lambda r: (r["mesh"], r["query"], r["place"])):
        group = list(group)
        if mesh not in libraries:
            libraries[mesh] = [kind(*read_obj(arguments.folder / mesh)) for kind in (Coal, Fcl)]
        poses = [
            (rotation(*(float(row[k]) for k in ("qx", "qy", "qz", "qw"))),
             numpy.array([float(row[k]) for k in ("tx", "ty", "tz")]))
            for row in group
        ]
        ours = [float(row["sbbk"]) for row in group]
        times, differ = [], []
        for library in libraries[mesh]:
            best, answers = measure(library, QUERIES[query], poses, arguments.repeats)
            times.append(best)
            wrong = sum(abs(a - b) > TOLERANCE for a, b in zip(answers, ours))
            differ.append(f"{wrong} of {len(poses)}")
        stock, sbbk = (float(group[0][k]) for k in ("stock_us", "sbbk_us"))
        ratios.setdefault(query, []).append(min(times) / sbbk)
        cells = [query, place, mesh, f"{stock:.1f}", f"{sbbk:.1f}", *(f"{t:.1f}" for t in times),
                 f"{min(times) / sbbk:.2f}x", *differ]
        print("| " + " | ".join(cells) + " |", flush=True)
    for query, values in ratios.items():
        print(f"{query}: geometric mean {mean(values):.2f} times faster than the better of both")
    print(f"a call that finds nothing, µs: {call_cost()}")


if __name__ == "__main__":
    main()
