"""Holds scenes/scene.schema.json against scene files with a validator that shares nothing with the program.

Every shipped scene is valid, as it is written and as `migiwa check --print` writes it out in full. Every file of
the bad corpus is refused, at the very places where the program refuses it.

usage: validate_scenes.py SOURCE_FOLDER MIGIWA
"""

import json
import pathlib
import re
import subprocess
import sys

import jsonschema

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
schema_file = source / "scenes" / "scene.schema.json"
schema = json.loads(schema_file.read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)
failures = []

# What the program says about single values; anything else takes a calculation, which a schema cannot do.
SINGLE_VALUE = re.compile(
    r"expected (a number|a whole number|an array|an object|one of (?!.file)|either of|a known key|a text|true or false|1, found"
    r"|\"|\[\.\.\.\])"
)


def pointer(path):
    return "".join("/" + str(part).replace("~", "~0").replace("/", "~1") for part in path)


def parent(place):
    return place[: place.rfind("/")] if "/" in place else ""


def places(document):
    return {pointer(error.absolute_path) for error in validator.iter_errors(document)}


def check(condition, message):
    if not condition:
        failures.append(message)


shipped = sorted((source / "scenes").rglob("*.json"))
shipped.remove(schema_file)
for file in shipped:
    document = json.loads(file.read_text())
    check(not places(document), f"{file}: refused at {sorted(places(document))}")
    named = document.get("$schema", "")
    check((file.parent / named).resolve() == schema_file.resolve(), f'{file}: expected "$schema" to lead to {schema_file}')
    printed = subprocess.run([program, "check", "--print", str(file)], capture_output=True, text=True, check=True).stdout
    check(not places(json.loads(printed)), f"{file}: written in full, refused at {sorted(places(json.loads(printed)))}")

compared = 0
for file in sorted((source / "tests" / "scene" / "bad").glob("*.json")):
    try:
        document = json.loads(file.read_text(), parse_constant=float)
    except ValueError:
        continue  # broken JSON is not a matter of the schema
    faults = {}  # the pointer of each fault, and whether a schema can see it
    for line in file.with_suffix(".expected").read_text().splitlines():
        name, place, message = re.fullmatch(r"([^:]*):(\S*): (.*)", line).groups()
        if name != file.name or not place.startswith("/"):
            continue
        faults["" if place == "/" else place] = bool(SINGLE_VALUE.match(message)) and "again" not in message
    if not faults:
        continue  # what Python's reader lets pass is not JSON all the same
    found = places(document)
    for place in found:
        near = any(fault == place or fault.startswith(place + "/") for fault in faults)
        check(near, f"{file.name}: the schema refuses {place or '/'}, the program does not")
    for place, visible in faults.items():
        if visible and not place.startswith("/set/"):  # what a pointer leads to is not the schema's to know
            compared += 1
            check({place, parent(place)} & found, f"{file.name}: the program refuses {place or '/'}, the schema does not")

check(len(shipped) >= 10 and compared >= 60, f"only {len(shipped)} scenes and {compared} faults were compared")
for failure in failures:
    print(failure)
print(f"{len(shipped)} scenes, {compared} faults, {len(failures)} failures")
sys.exit(1 if failures else 0)
