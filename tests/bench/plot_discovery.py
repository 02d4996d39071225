#!/usr/bin/env python3
"""Draws what discovery_bench measured, with gnuplot.

usage: plot_discovery.py WITHOUT_SERVER.json WITH_SERVER.json PICTURE.png
The files are the output of `discovery_bench --json`, without and with --discovery-server.
"""
import json
import subprocess
import sys
from pathlib import Path

PANELS = [("megabytes_until", "traffic until all exchange their topics, MB"), ("until_s", "time until then, s"),
          ("cpu_until_s", "CPU time until then, s"), ("kilobytes_per_s_at_rest", "traffic at rest, kB/s")]


def main(without, with_server, picture):
    rows = [("without a server", json.loads(Path(without).read_text(encoding="utf-8"))),
            ("with a discovery server", json.loads(Path(with_server).read_text(encoding="utf-8")))]
    script = [f"set terminal pngcairo size 1000,700\nset output '{picture}'\nset multiplot layout 2,2\nset logscale xy\n"
              "set grid\nset key bottom right\nset xlabel 'processes'\nset xrange [3:250]\nset xtics (4, 12, 40, 80, 200)\n"]
    for key, title in PANELS:
        script.append(f"set title '{title}'\nplot " + ", ".join(
            f"'-' with linespoints pointtype 7 linewidth 2 title '{name}'" for name, _ in rows) + "\n")
        for _, measured in rows:
            script.extend(f"{row['processes']} {row[key]}\n" for row in measured if row["know_all"] == row["processes"])
            script.append("e\n")
    subprocess.run(["gnuplot"], input="".join(script), text=True, check=True)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
