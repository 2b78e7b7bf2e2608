"""Whether all packages of a list of requirements are there."""

from __future__ import annotations

import re
import sys
from importlib import metadata

names = [re.split(r"[<>=!~\[; ]", line.strip())[0] for line in sys.stdin if line.strip()]
missing = []
for name in names:
    try:
        metadata.version(name)
    except metadata.PackageNotFoundError:
        missing.append(name)
if missing:
    print("not installed:", ", ".join(missing))
sys.exit(bool(missing))
