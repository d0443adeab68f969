#!/usr/bin/env python3
"""Draws the charts of measurements.md from its tables: python3 docs/charts.py"""
import math
import re
from html import escape
from pathlib import Path

DOCS = Path(__file__).parent
WIDTH = 900
COLOURS = {"stock": "#333333", "flag": "#8a8a8a", "SBBK": "#0072b2", "other": "#d55e00"}
NUMBER = re.compile(r"\d[\d,]*\.?\d*")


def table(name):
    """Rows of cells of the table with this name."""
    text = (DOCS / "measurements.md").read_text()
    body = re.search(rf"<!-- table: {name} -->\n(.*?)<!-- end -->", text, re.S)[1]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in body.splitlines()]
    return rows[:1] + rows[2:]


def numbers(cell):
    """Numbers of a cell, without what stands in brackets."""
    return [float(n.replace(",", "")) for n in NUMBER.findall(re.sub(r"\(.*?\)", "", cell))]


class Chart:
    def __init__(self, title, height):
        self.height = height
        self.parts = []
        self.text(20, 28, title, size=18)

    def text(self, x, y, text, size=13, anchor="start", colour="#222222"):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" '
                          f'text-anchor="{anchor}" fill="{colour}">{escape(text)}</text>')

    def line(self, points, colour="#dddddd", width=1):
        at = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{at}" fill="none" stroke="{colour}" stroke-width="{width}"/>')

    def dot(self, x, y, colour):
        self.parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{colour}" fill-opacity="0.8"/>')

    def bar(self, x, y, width, colour):
        self.parts.append(f'<rect x="{x}" y="{y}" width="{width:.1f}" height="18" fill="{colour}"/>')

    def save(self, name):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{self.height}" '
                f'viewBox="0 0 {WIDTH} {self.height}" font-family="sans-serif">\n'
                f'<rect width="{WIDTH}" height="{self.height}" fill="white"/>\n')
        (DOCS / name).write_text(head + "\n".join(self.parts) + "\n</svg>\n")


def everyday():
    """A row of dots for each scene: how many times faster than stock."""
    rows = [(row[0], numbers(row[1])) for row in table("everyday")[1:] if not row[0].startswith("all ")]
    left, top, step = 470, 70, 26
    chart = Chart("Everyday scenes: how many times faster than stock", top + step * len(rows) + 40)
    x_of = lambda ratio: left + 112 * math.log2(ratio / 0.8)
    bottom = top + step * len(rows)
    for tick in [1, 2, 4, 8]:
        colour, width = ("#222222", 2) if tick == 1 else ("#dddddd", 1)
        chart.line([(x_of(tick), top - 8), (x_of(tick), bottom)], colour, width)
        chart.text(x_of(tick), bottom + 20, "1: as fast" if tick == 1 else str(tick), anchor="middle")
    for k, (scene, ratios) in enumerate(rows):
        y = top + step * k + 10
        chart.text(left - 30, y + 4, scene if len(scene) < 64 else scene[:62] + "…", anchor="end")
        for ratio in ratios:
            chart.dot(x_of(ratio), y, COLOURS["SBBK"] if ratio >= 1 else COLOURS["other"])
    chart.save("everyday.svg")


def one_step():
    """Error of a step by the number of substeps."""
    head, *rows = table("one_step")
    steps = [int(cell) for cell in head[1:-1]]
    left, bottom, top = 70, 330, 60
    chart = Chart("Error of one step, as a share of the contact impulse: lower is better", 390)
    x_of = lambda n: left + 110 * math.log2(n)
    y_of = lambda error: bottom - (bottom - top) * error / 0.6
    for tick in [0, 0.2, 0.4, 0.6]:
        chart.line([(left, y_of(tick)), (x_of(steps[-1]), y_of(tick))])
        chart.text(left - 10, y_of(tick) + 4, f"{tick:g}", anchor="end")
    for n in steps:
        chart.text(x_of(n), bottom + 22, str(n), anchor="middle")
    chart.text(x_of(steps[-1]) / 2, bottom + 46, "substeps", anchor="middle")
    colours = [COLOURS["stock"], COLOURS["SBBK"], COLOURS["other"]]
    for row, colour in zip(rows, colours):
        points = [(x_of(n), y_of(numbers(cell)[0])) for n, cell in zip(steps, row[1:])]
        chart.line(points, colour, 3)
        chart.text(points[-1][0] + 12, points[-1][1] + 4, row[0], colour=colour)
    chart.save("one_step.svg")


def engines():
    """Time of a step of the pile of 200 heads."""
    head, *rows = table("engines")
    left, top, step = 130, 60, 30
    names = head[1:]
    chart = Chart("A pile of 200 meshes in motion: ms a step, lower is better", top + step * len(names) + 10)
    row = next(row for row in rows if "in motion" in row[0])
    times = [numbers(cell)[0] for cell in row[1:]]
    for k, (name, time) in enumerate(zip(names, times)):
        y = top + step * k
        width = 680 * time / max(times)
        chart.text(left - 10, y + 14, name, anchor="end")
        chart.bar(left, y, width, COLOURS["SBBK"] if name == "SBBK" else COLOURS["flag"])
        chart.text(left + width + 8, y + 14, f"{time:g}")
    chart.save("engines.svg")


def tuning():
    """Scenes that hold if a number is halved, as it is, and doubled."""
    text = (DOCS / "data/tuning.csv").read_text()
    base, scenes = [int(n) for n in re.findall(r"# (\d+) of (\d+) scenes", text)[0]]
    rows = [[row[0].strip("`"), *(int(cell) for cell in row[4:])] for row in table("tuning")[1:]]
    left, top, step = 230, 80, 21
    bottom = top + step * len(rows)
    chart = Chart(f"Random scenes that hold, of {scenes}, if one number is halved or doubled", bottom + 40)
    least = min(min(row[1:]) for row in rows) - 10
    x_of = lambda held: left + (WIDTH - left - 40) * (held - least) / (scenes - least)
    for tick in range(least - least % 10 + 10, scenes + 1, 10):
        chart.line([(x_of(tick), top - 8), (x_of(tick), bottom)])
        chart.text(x_of(tick), bottom + 20, str(tick), anchor="middle")
    chart.line([(x_of(base), top - 8), (x_of(base), bottom)], "#222222", 2)
    chart.text(x_of(base), top - 14, f"as they are: {base}", anchor="middle")
    for x, name, colour in [(20, "half", "other"), (90, "double", "SBBK")]:
        chart.dot(x + 6, 55, COLOURS[colour])
        chart.text(x + 18, 59, name)
    for k, (name, half, double) in enumerate(rows):
        y = top + step * k + 10
        chart.text(left - 14, y + 4, name, anchor="end")
        chart.dot(x_of(half), y - 2, COLOURS["other"])
        chart.dot(x_of(double), y + 2, COLOURS["SBBK"])
    chart.save("tuning.svg")


everyday()
one_step()
engines()
tuning()
