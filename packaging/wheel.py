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
         "-DMIGIWA_PYTHON=ON", "-DMIGIWA_PYTHON_DIR=.", f"-DPython_EXECUTABLE={sys.executable}"],
        ["cmake", "--build", build, "--parallel", jobs, "--target", "migiwa_python"],
        ["cmake", "--install", build, "--component", "python", "--prefix", prefix, "--strip"],
    ):
        subprocess.run([str(word) for word in command], check=True)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes migiwa-VERSION-*.whl into a folder and returns its name."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub("[-.]", "_", sysconfig.get_platform())
    name = f"migiwa-{VERSION}-{python}-{python}-{platform}.whl"
    info = f"migiwa-{VERSION}.dist-info"
    with tempfile.TemporaryDirectory() as scratch:
        _install(ROOT / "build" / "wheel", scratch)
        package = pathlib.Path(scratch) / "migiwa"
        files = {f"migiwa/{path.name}": path.read_bytes() for path in sorted(package.iterdir())}
    files[f"{info}/METADATA"] = METADATA.encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: migiwa\nRoot-Is-Purelib: false\nTag: {python}-{python}-{platform}\n".encode()
    )
    record = []
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{path},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = ("".join(record) + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            wheel.writestr(path, content)
    return name
