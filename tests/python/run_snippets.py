"""Runs the Python of a document: its fenced blocks, one after another as one program, in an empty folder.

A line of a block that ends in `# prints TEXT` has to print TEXT, and nothing else is printed.
"""

import contextlib
import io
import os
import pathlib
import re
import sys
import tempfile

blocks = []
for document in sys.argv[1:]:
    path = pathlib.Path(document).resolve()
    found = re.findall(r"^```python\n(.*?)^```", path.read_text(), re.MULTILINE | re.DOTALL)
    if not found:
        sys.exit(f"{document}: expected blocks of Python, found none")
    blocks.append((path, found))

for path, found in blocks:
    names = {"__name__": "__main__"}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        os.symlink(path.parent / ("scenes" if (path.parent / "scenes").exists() else "../scenes"), "scenes")
        for number, block in enumerate(found, 1):
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(block, f"{path.name}, block {number}", "exec"), names)
            wanted = re.findall(r"# prints (.*)$", block, re.MULTILINE)
            if [line.strip() for line in wanted] != [line.strip() for line in printed.getvalue().splitlines()]:
                sys.exit(f"{path.name}, block {number}: expected {wanted}, found {printed.getvalue().splitlines()}")
        os.chdir("/")
    print(f"{path.name}: {len(found)} blocks")
