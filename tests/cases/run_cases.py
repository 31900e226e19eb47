#!/usr/bin/env python3
"""run_cases.py PROGRAM OUT [--duration S] [FOLDER]: simulates every scene of a folder, each for its own duration or at most
S seconds, checks the meshes there that no scene names, and prints what became of them. Without a folder it writes our own
kinds of files (write_cases.py) and compares each with what it is to come to. Logs and reports go to OUT."""
import argparse
import json
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True
import write_cases

MESHES = {".obj", ".ply", ".stl", ".off", ".xyz", ".dae", ".3ds", ".gltf", ".glb"}
SCENE_KEYS = {"format", "fluid", "boundary", "emitters", "particle_spacing", "include"}
COLUMNS = ["case", "exit", "particles", "left", "drained", "lost", "gain", "warnings", "trouble", "time"]
UNITS = {"gain": "J/kg", "time": "s"}
LONGEST = 10.0  # of simulated time, where nothing else is said (s)
PATIENCE = 1800  # for one run (s)


def scene_in(file):
    """The scene of a file as JSON; {} for text that is no JSON, None for JSON that is no scene."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
    except ValueError:
        return {}
    return content if isinstance(content, dict) and SCENE_KEYS & content.keys() else None


def run(command, log):
    """Exit code, or "killed", "endless", and what was said."""
    try:
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=PATIENCE, check=False)
        code, said = done.returncode, done.stderr
    except subprocess.TimeoutExpired as expired:
        code, said = "endless", expired.stderr or b""
    log.write_bytes(said)
    return ("killed" if isinstance(code, int) and code < 0 else code), said.decode(errors="replace").splitlines()


def row_of(name, command, out, report=None):
    began = time.monotonic()
    code, said = run(command, out / f"{name}.log")
    row = {"case": name, "exit": code, "warnings": sum(": warning: " in line for line in said)}
    row["time"] = round(time.monotonic() - began, 1)
    if report is not None and report.exists():
        told = json.loads(report.read_text())
        row |= {"particles": told["totals"]["started"], "left": told["left"]["particles"],
                "drained": told["drained"]["particles"], "lost": told["lost_particles"],
                "gain": told["energy"]["largest_gain"],
                "trouble": sum(trouble["kind"] != "not_converged" for trouble in told["trouble"])}
    return row, said


def simulate(program, file, scene, out, longest):
    own = scene.get("duration")
    until = min(own, longest) if isinstance(own, (int, float)) else longest
    report = out / f"{file.stem}.report.json"
    report.unlink(missing_ok=True)
    return row_of(file.stem, [program, "simulate", file, "--until", str(until), "--quiet", "--report", report], out,
                  report)


def check_mesh(program, file, out):
    """As a wall, for a mesh is no scene."""
    scene = out / f"{file.name}.json"
    wall = {"shape": "mesh", "file": str(file.resolve()), "fluid": "outside"}
    scene.write_text(json.dumps({"format": 1, "boundary": {"surfaces": [wall]}}))
    return row_of(file.name, [program, "check", scene], out)


def text_of(row, column):
    value = row.get(column)
    return "-" if value is None else f"{value:.3g}" if column == "gain" else str(value)


def print_table(rows):
    heads = [f"{column} ({UNITS[column]})" if column in UNITS else column for column in COLUMNS]
    cells = [heads] + [[text_of(row, column) for column in COLUMNS] for row in rows]
    widths = [max(len(line[k]) for line in cells) for k in range(len(COLUMNS))]
    for line in cells:
        print("  ".join(cell.ljust(width) if k == 0 else cell.rjust(width)
                        for k, (cell, width) in enumerate(zip(line, widths))))


def differences(row, expected):
    for column, wanted in expected.items():
        found, (low, high) = row.get(column), wanted if isinstance(wanted, tuple) else (wanted, wanted)
        if not isinstance(found, (int, float)) or not low <= found <= high:
            yield f"{row['case']}: expected {column} {wanted if low == high else f'from {low} to {high}'}, found {found}"


def main():
    parser = argparse.ArgumentParser(prog="./run cases", description="Runs every scene of a folder.")
    parser.add_argument("program", help=argparse.SUPPRESS)
    parser.add_argument("out", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("folder", type=pathlib.Path, nargs="?", help="left out: our own kinds of files")
    parser.add_argument("--duration", type=float, default=LONGEST, metavar="S",
                        help=f"simulated time of a run at most, {LONGEST:g} s if left out")
    options = parser.parse_args()
    out = options.out
    out.mkdir(parents=True, exist_ok=True)
    expected = {}
    folder = options.folder
    if folder is None:
        folder = out / "files"
        expected = write_cases.write(folder)
    elif not folder.is_dir():
        parser.error(f"expected a folder, found {folder}")

    scenes = {file: scene for file in sorted(folder.glob("*.json")) if (scene := scene_in(file)) is not None}
    text = "".join(file.read_text(encoding="utf-8", errors="replace") for file in scenes)
    meshes = [file for file in sorted(folder.iterdir()) if file.suffix.lower() in MESHES and file.name not in text]
    runs = [(file.stem, lambda f=file, s=scene: simulate(options.program, f, s, out, options.duration))
            for file, scene in scenes.items()]
    runs += [(file.name, lambda f=file: check_mesh(options.program, f, out)) for file in meshes]
    if not runs:
        parser.error(f"expected scenes or meshes in {folder}, found none")

    rows, faults = [], []
    for name, start in runs:
        print(f"{name} ...", file=sys.stderr, flush=True)
        row, said = start()
        rows.append(row)
        faults += list(differences(row, expected.get(name, {})))
        if row["exit"] not in (0, 2, 3, 4):
            faults.append(f"{name}: ended with {row['exit']}")
        if row["exit"] != 0 and name not in expected:
            print("\n".join("  " + line for line in said[:5]), file=sys.stderr)
    print_table(rows)
    print(f"\nWhat each said is in {out}/CASE.log")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


sys.exit(main())
