"""Runs the examples of examples/python, small, and looks at what they print and write."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

examples = pathlib.Path(os.environ["MIGIWA_SOURCE"]) / "examples/python"


def expect(holds, what):
    if not holds:
        sys.exit(what)


def run(folder, name, *arguments):
    result = subprocess.run([sys.executable, examples / name, *arguments], cwd=folder, capture_output=True, text=True,
                            env={**os.environ, "MPLBACKEND": "Agg"})
    expect(result.returncode == 0, f"{name}\n{result.stdout}{result.stderr}")
    print(result.stdout, end="")
    return result.stdout


with tempfile.TemporaryDirectory() as scratch:
    folder = pathlib.Path(scratch)
    largest = float(re.search(r"Eq. 14: (\S+),", run(folder, "figure3.py", "24")).group(1))
    # The paper finds some 20 % in the middle of the nodes, docs/gamma.md 0.25 along the edge.
    expect(0.15 < largest < 0.27, f"expected the paper's error, found {largest}")
    expect((folder / "figure3.png").stat().st_size > 5000, "expected a picture of Figure 3")

    lines = run(folder, "cost_against_accuracy.py", "0.2").splitlines()
    expect(len(lines) == 8 and (folder / "cost_against_accuracy.png").exists(), f"expected eight runs, found {lines}")

    errors = [float(line.split()[-1].rstrip("%")) for line in lines if line.startswith("gamma")]
    expect(errors == sorted(errors, reverse=True), f"expected errors that fall with the iterations, found {errors}")

    run(folder, "stairs_to_vtk.py", "0.3")
    files = sorted(folder.glob("stairs_*.vtk"))
    expect(len(files) == 4, f"expected four files, found {files}")
    expect(all(b"\nvelocity 3 " in file.read_bytes() for file in files), "expected velocities in all files")

    off = float(re.search(r"cos\(w t\): (\S+) m", run(folder, "custom_force.py")).group(1))
    # The closed form, with the first order of the time step: w^2 dt t / 2 of the amplitude.
    expect(off < 0.5 * 40 * 0.002 * 1.2 / 2 + 0.002, f"expected the closed form, found {off} m off")

count = len(list(examples.glob("*.py")))
expect(count == 4, f"expected a test for each example, found {count} examples")
