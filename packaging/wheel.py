"""Builds a wheel of the Python package: what pip asks of a build backend (PEP 517), done by CMake."""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
VERSION = re.search(r"project\(migiwa VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
METADATA = f"""Metadata-Version: 2.1
Name: migiwa
Version: {VERSION}
Summary: Particle fluids with the density corrected at walls
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
"""


def _install(build, prefix):
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
    for command in (
        ["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DMIGIWA_PROGRAM=ON",
         "-DMIGIWA_PYTHON=ON", "-DMIGIWA_PYTHON_DIR=.", f"-DPython_EXECUTABLE={sys.executable}",
         *os.environ.get("CMAKE_ARGS", "").split()],
        ["cmake", "--build", build, "--parallel", jobs, "--target", "migiwa_python"],
        ["cmake", "--install", build, "--component", "python", "--prefix", prefix, "--strip"],
    ):
        subprocess.run([str(word) for word in command], check=True)


def _information():
    """Files of the folder NAME.dist-info, but for the list of all files."""
    python, platform = _tags()
    wheel = f"Wheel-Version: 1.0\nGenerator: migiwa\nRoot-Is-Purelib: false\nTag: {python}-{python}-{platform}\n"
    return {"METADATA": METADATA.encode(), "LICENSE": (ROOT / "LICENSE").read_bytes(), "WHEEL": wheel.encode()}


def _tags():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return python, re.sub("[-.]", "_", sysconfig.get_platform())


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Writes what is known before anything is built, and returns the folder's name."""
    folder = pathlib.Path(metadata_directory) / f"migiwa-{VERSION}.dist-info"
    folder.mkdir()
    for name, content in _information().items():
        (folder / name).write_bytes(content)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes migiwa-VERSION-*.whl into a folder and returns its name."""
    python, platform = _tags()
    name = f"migiwa-{VERSION}-{python}-{python}-{platform}.whl"
    info = f"migiwa-{VERSION}.dist-info"
    with tempfile.TemporaryDirectory() as scratch:
        _install(ROOT / "build" / "wheel", scratch)
        package = pathlib.Path(scratch) / "migiwa"
        files = {f"migiwa/{path.name}": path.read_bytes() for path in sorted(package.iterdir())}
    files.update({f"{info}/{name_of}": content for name_of, content in _information().items()})
    record = []
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{path},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = ("".join(record) + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            wheel.writestr(path, content)
    return name
