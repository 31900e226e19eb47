"""Writes migiwa.1, the man page, and migiwa.bash, the completion for bash, of what the program says with --help.

describe_program.py PROGRAM VERSION FOLDER
"""

import pathlib
import re
import subprocess
import sys

program, version, folder = sys.argv[1:]
out = pathlib.Path(folder)


def help_of(*command):
    return subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True).stdout


def sections_of(text):
    """(heading, lines) of a help text; the heading of what comes first is empty."""
    sections = [("", [])]
    for line in text.splitlines():
        if re.fullmatch(r"[A-Z][A-Za-z ]*:", line):
            sections.append((line[:-1], []))
        elif line.strip() or sections[-1][1]:
            sections[-1][1].append(line)
    return sections


def entries_of(lines):
    """(words, what they are) of an indented list, and the lines after it."""
    entries, rest = [], []
    for line in lines:
        entry = re.fullmatch(r"  (\S(?:.*?\S)?)(?: {2,}(.*))?", line)
        if line.startswith("   ") and entries and not rest:
            entries[-1][1] = (entries[-1][1] + " " + line.strip()).strip()
        elif entry and not rest:
            entries.append([entry[1], entry[2] or ""])
        elif line.strip():
            rest.append(line)
    return entries, rest


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def roff_of(text, common):
    """What a help text lists; sections named in `common` are left out."""
    lines = []
    for heading, body in sections_of(text):
        if not heading or heading in common:
            continue
        entries, rest = entries_of(body)
        if heading != "Options":
            lines += [".PP", roff(heading) + ":"]
        for words, meaning in entries:
            words = re.sub(r":(INT|FLOAT|TEXT)\b", "", words)
            lines += [".TP", ".B " + roff(words), roff(meaning)]
        for line in rest:
            lines += [".PP", roff(line.strip())]
    return lines


top = help_of()
commands = entries_of(dict(sections_of(top))["Subcommands"])[0]
shared = ("Exit codes", "Every command")
page = [
    f'.TH MIGIWA 1 "" "migiwa {version}" "User Commands"',
    ".SH NAME",
    "migiwa \\- simulates liquids with particles, with the density corrected at walls",
    ".SH SYNOPSIS",
    ".B migiwa",
    ".RI [ COMMAND ]",
    ".RI [ OPTIONS ]",
    ".SH DESCRIPTION",
    "Without a command, a window opens on a dam break. Scenes are JSON files;",
    ".I /usr/share/migiwa/scenes",
    "has some, and their schema.",
    ".SH COMMANDS",
]
words_of = {}
for name, meaning in commands:
    text = help_of(name)
    usage = next(line for line in text.splitlines() if line.startswith("Usage: "))
    page += [f".SS {roff(usage.removeprefix('Usage: '))}", roff(meaning), *roff_of(text, shared)]
    words_of[name] = sorted(set(re.findall(r"^  (?:-h,)?(--[a-z-]+)", text, re.MULTILINE)))
page += [".SH OPTIONS", "Every command takes these."]
page += roff_of("\n".join(["Options:", *dict(sections_of(help_of(commands[0][0])))["Every command"]]), ())
page += [".SH EXIT STATUS"]
for code, meaning in entries_of(dict(sections_of(top))["Exit codes"])[0]:
    page += [".TP", ".B " + code, roff(meaning)]
page += [".SH FILES", ".TP", ".I /usr/share/migiwa/scenes", "Scenes, with README.md that lists every key.",
         ".SH ENVIRONMENT", ".TP", ".B MIGIWA_CACHE", "Folder for grids and fits that are kept for the next start."]

completion = ["# bash completion for migiwa", "_migiwa() {", '  local word=${COMP_WORDS[COMP_CWORD]} command=${COMP_WORDS[1]}',
              "  local words", "  if [[ $COMP_CWORD -eq 1 && $word != -* ]]; then",
              f'    words="{" ".join(name for name, _ in commands)}"', "  else", "    case $command in"]
completion += [f'      {name}) words="{" ".join(words)}" ;;' for name, words in words_of.items()]
completion += ['      *) words="--help" ;;', "    esac", "    [[ $word == -* ]] || words=", "  fi",
               '  COMPREPLY=($(compgen -W "$words" -- "$word"))',
               "  # Files are completed where no word fits.", "}", "complete -o default -F _migiwa migiwa"]

out.mkdir(parents=True, exist_ok=True)
(out / "migiwa.1").write_text("\n".join(page) + "\n")
(out / "migiwa.bash").write_text("\n".join(completion) + "\n")
