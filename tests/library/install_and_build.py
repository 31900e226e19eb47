"""Installs a build into an empty prefix, builds examples/cpp against it as another project would, and runs it."""

import pathlib
import re
import shutil
import subprocess
import sys

build, source, scratch = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
prefix, project = scratch / "prefix", scratch / "project"


def run(*command, **more):
    result = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}{result.stderr}")
    return result.stdout


def expect(holds, what):
    if not holds:
        sys.exit(what)


shutil.rmtree(scratch, ignore_errors=True)
for component in ("program", "dev"):
    run("cmake", "--install", build, "--prefix", prefix, "--component", component)

# Installed headers include one another and what dependencies have, and nothing of this repository.
headers = list((prefix / "include").rglob("*.h"))
expect(len(headers) > 20, f"expected the headers, found {headers}")
for header in headers:
    for included in re.findall(r'^#include "([^"]+)"', header.read_text(), re.MULTILINE):
        expect((prefix / "include" / included).exists(), f"{header}: there is no {included}")
expect(not list((prefix / "include").rglob("*simd*")), "expected no vector loops among the headers")

# A folder of the other project that is called core must not stand for ours.
shutil.copytree(source / "examples/cpp", scratch / "example")
(scratch / "example/core/scene").mkdir(parents=True)
(scratch / "example/core/scene/scene.h").write_text("#error This is not Migiwa's.\n")
run("cmake", "-S", scratch / "example", "-B", project, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
    "-DCMAKE_CXX_FLAGS=-I" + str(scratch / "example"))
run("cmake", "--build", project)
# The same project with the library's sources in it: it is configured, and its own file is compiled. To build the library, too,
# would take minutes, and be what built it here.
run("cmake", "-S", source / "examples/cpp", "-B", scratch / "with_sources", "-G", "Ninja", f"-DMIGIWA_SOURCE={source}")
run("cmake", "--build", scratch / "with_sources", "--target", "CMakeFiles/ring_in_the_wind.dir/ring_in_the_wind.cpp.o")
libraries = next(prefix.rglob("libmigiwa_core.so")).parent
lines = {run(program, env={"LD_LIBRARY_PATH": str(libraries)})
         for program in (project / "ring_in_the_wind", project / "ring_in_the_wind_shared")}
expect(len(lines) == 1, f"expected the same from both libraries, found {lines}")
line = lines.pop()
speed, clearance = (float(number) for number in re.search(r"at (\S+) m/s, (\S+) m from the ring", line).groups())
expect(1 < speed < 4 * 0.5, f"expected a mean speed below a t = 2 m/s, for the ring holds water up, found {line}")
expect(abs(clearance - 0.02) < 0.001, f"expected water against the ring, half a spacing from it, found {line}")

# The installed program finds its scenes from any folder.
share = prefix / "share/migiwa"
for name in ("scenes/dam_break.json", "scenes/scene.schema.json", "scenes/truth/free_fall.json", "shaders"):
    expect((share / name).exists(), f"expected {share / name}, found nothing")
program = prefix / "bin/migiwa"
run(program, "check", share / "scenes/dam_break.json", cwd=scratch)
run(program, "truth", "free_fall", "--quick", "--quiet", "--out", scratch / "truth", cwd=scratch)
print(line, end="")
