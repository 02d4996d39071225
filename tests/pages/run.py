#!/usr/bin/env python3
"""Opens the HTML pages that the programs write in headless Chromium.

usage: run.py BIN WORK

BIN holds the programs, WORK is a folder for files, also for pictures of the pages; the browser's driver (package-lock.json) is
installed into it with npm.
"""
import json
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
MISSION = """
name: hop
frame: ned
tolerance_m: 0.1
items:
  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5, hold_s: 0.5}
  - {kind: waypoint, position_m: [0.5, 0.3, -0.5], speed_m_s: 0.5}
  - {kind: land, speed_m_s: 0.5}
"""
CHARTS = {"Position", "Position error", "Attitude", "Gyroscope", "Rotor commands", "Supply voltage",
          "Estimate minus ground truth, position, with 3 σ", "Innovation: pose minus estimate, position, with 3 σ of both",
          "Delay of the loop"}


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"pages: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-3000:]}")
    return done.stdout


def require(holds, what):
    if not holds:
        sys.exit(f"pages: {what}")


def check_flights(swiftlet, work):
    (work / "hop.yaml").write_text(MISSION, encoding="utf-8")
    for seed in (1, 2):
        run(swiftlet, "fly", "hop.yaml", "--clock", "lockstep", "--localhost-only", "--seed", seed, "--record",
            work / f"hop{seed}", "--replace", cwd=work)
    run(swiftlet, "report", work / "hop1", "-o", work / "one.html", "--replace")
    run(swiftlet, "report", work / "hop1" / "flight.mcap", work / "hop2", "-o", work / "two.html", "--replace")
    found = json.loads(run("node", work / "flight.mjs", work / "one.html", work / "two.html", work, cwd=work))

    flight = json.loads((work / "hop1" / "report.json").read_text(encoding="utf-8"))
    rms_mm = float(found["summary"]["error 3-D, RMS"].split()[0])
    require(abs(rms_mm / (1e3 * flight["rms_3d_m"]) - 1) < 0.03, f"the page says {rms_mm} mm, the report {flight['rms_3d_m']} m")
    require(CHARTS <= set(found["charts"]), f"missing: {CHARTS - set(found['charts'])}")
    require(any("mission running, item 2 of 3" in event for event in found["events"]), f"events: {found['events']}")
    require(found["overlaid"] == ["hop1", "hop1, reference", "hop2", "hop2, reference"] and found["vehicles"] == 2,
            f"two flights: {found['overlaid']}")
    north = found["table"][1]
    require(north[0] == "north" and abs(float(north[5]) - 0.5) < 0.03, f"the table of positions: {north}")
    print(f"pages: {len(found['charts'])} charts of a flight, ready after {found['ready_ms']} ms: zoom, slider, texts, two flights; "
          "light and dark, 1280 and 390 px")


def check_figures(swiftlet, work):
    shutil.rmtree(work / "bench", ignore_errors=True)
    run(swiftlet, "identify", "simulate", "--vehicle", "kaylion", "--noise", "0.01", "--outliers", "0.04", "--seed", "3", "--out", "bench",
        cwd=work)
    run(swiftlet, "identify", "bench", "--out", "mine.yaml", "--report", "bench.html", cwd=work)
    run(swiftlet, "sim", "batch", "hop.yaml", "--runs", "30", "--dispersion", "kaylion", "--out", "batch", "--replace", cwd=work)
    found = json.loads(run("node", work / "figures.mjs", work, work / "bench.html", work / "batch" / "batch.html", cwd=work))
    require(sum(caption.startswith("Fig. ") for caption in found["bench.html"]) == 5, f"figures: {found['bench.html']}")
    require("phase margin (deg)" in found["batch.html"], f"figures: {found['batch.html']}")
    print(f"pages: {sum(map(len, found.values()))} figures of an identification and a batch")


def check_mission(swiftlet, work):
    run(swiftlet, "mission", "plot", "hop.yaml", "-o", "mission.html", cwd=work)
    found = json.loads(run("node", work / "mission.mjs", work / "mission.html", work, cwd=work))
    require({"Position", "Speed", "Acceleration", "Tilt of the thrust"} <= set(found["charts"]), f"charts: {found['charts']}")
    require(found["speed"] == ["speed", "speed limit"] and found["fence"], f"limits: {found}")
    print("pages: a mission with its limits and fence")


def install_browser(work):
    work.mkdir(parents=True, exist_ok=True)
    for file in HERE.glob("*.*js*"):
        shutil.copy(file, work)
    run("npm", "ci", "--omit=dev", "--no-audit", "--no-fund", "--ignore-scripts", cwd=work)


def main(programs, work):
    install_browser(work)
    for check in (check_flights, check_mission, check_figures):
        check(programs / "swiftlet", work)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
