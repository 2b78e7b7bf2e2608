"""Prints the table from the folder `run` wrote: the best of all rounds of each case, beside ours of the same threads."""

import csv
import json
import os
import pathlib
import platform
import sys
import time


def ours(folder):
    for path in folder.glob("ours-*/bench.csv"):
        with open(path) as file:
            for row in csv.DictReader(file):
                cells = int(row["cells"])
                yield {
                    "program": "sinew",
                    "version": "this tree",
                    "threads": int(row["threads"]),
                    "cells": cells,
                    "ns": float(row["ns_per_element_step"]),
                    "top": watched(folder / f"top-{cells}" / "probe_top.csv"),
                    "note": "",
                }


def watched(path):
    with open(path) as file:
        return float(list(csv.reader(file))[-1][3])


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines() if os.path.exists("/proc/cpuinfo") else []
    words = {name.strip(): value.strip() for name, _, value in (line.partition(":") for line in lines)}
    wide = "AVX-512" if "avx512f" in words.get("flags", "") else "AVX2" if "avx2" in words.get("flags", "") else "no AVX2"
    return f"{words.get('model name', platform.processor())}, family {words.get('cpu family', '?')} model {words.get('model', '?')}, {wide}, {os.cpu_count()} cores"


def main(folder):
    lines = [json.loads(line) for line in (folder / "peers.jsonl").read_text().splitlines()]
    best = {}
    for row in [*ours(folder), *lines]:
        key = row["program"], row["threads"], row["cells"]
        if key not in best or row["ns"] < best[key]["ns"]:
            best[key] = row
    print(f"{time.strftime('%Y-%m-%d')}, {processor()}\n")
    print("| program | version | threads | cells | ns an element and step | times ours | top at 0.1 s |")
    print("|---|---|---|---|---|---|---|")
    for (program, threads, cells), row in sorted(best.items(), key=lambda item: (item[0][2], item[0][1], item[1]["ns"])):
        base = best.get(("sinew", threads, cells))
        times = f"{row['ns'] / base['ns']:.1f}" if base else ""
        note = f" ({row['note']})" if row["note"] else ""
        print(f"| {program}{note} | {row['version']} | {threads} | {cells}³ | {row['ns']:.1f} | {times} | {1000 * row['top']:.2f} mm |")


main(pathlib.Path(sys.argv[1]))
