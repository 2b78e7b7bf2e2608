#!/usr/bin/env python3
"""What a viscous history in fewer digits comes to: the recursion of `src/materials/prony.rs` after a step strain, for
three relaxation times, with the memory rounded in every step. Errors are shares of the stress."""

import math
import random
import struct

TAU = 0.58  # s


def single(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def half(x):
    return struct.unpack("e", struct.pack("e", x))[0]


def brain(x):
    bits = struct.unpack("I", struct.pack("f", x))[0]
    return struct.unpack("f", struct.pack("I", (bits + 0x7FFF + (bits >> 16 & 1)) & 0xFFFF0000))[0]


def by_chance(x):
    """Eleven bits, up or down with probabilities that keep the mean."""
    unit = 2.0 ** (math.frexp(x)[1] - 11) if x else 1.0
    below = math.floor(x / unit)
    return (below + (random.random() < x / unit - below)) * unit


print("| step (s) | " + " | ".join(["f32", "f16", "bf16", "f16 by chance"]) + " |\n|---|---|---|---|---|")
for step in (5e-5, 5e-6):
    row = []
    for rounded in (single, half, brain, by_chance):
        random.seed(1)
        rate = -math.expm1(-step / TAU)
        aim = -rate * TAU / step
        memory = exact = worst = 0.0
        for _ in range(int(3 * TAU / step)):
            memory = rounded(memory + rate * (aim - memory))
            exact += rate * (aim - exact)
            worst = max(worst, abs(memory - exact))
        row.append(f"{worst:.1e}")
    print(f"| {step:g} | " + " | ".join(row) + " |")
