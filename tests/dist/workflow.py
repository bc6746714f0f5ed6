"""The workflow file is YAML, and what it calls exists: workflow.py ROOT.

Each command line's program is ./do with a command that ./do help lists, a program of this machine, brew, or what CMake
builds; presets stand in CMakePresets.json, options in CMakeLists.txt, and packages for Homebrew in scripts/needs.txt.
SPDX-License-Identifier: MIT
"""
import json
import os
import re
import shlex
import shutil
import sys
from typing import List

import yaml

ROOT = sys.argv[1]


def read(name: str) -> str:
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return file.read()


COMMANDS = set(re.findall(r"^\./do ([a-z-]+)", re.search(r"<<'HELP'\n(.*?)^HELP", read("do"), re.M | re.S).group(1),
                          re.M))
PRESETS = {row["name"] for row in json.loads(read("CMakePresets.json"))["configurePresets"] if not row.get("hidden")}
OPTIONS = set(re.findall(r"^option\((KILN_\w+)", read("CMakeLists.txt"), re.M))
BREW = {line.split()[5] for line in read("scripts/needs.txt").splitlines() if line and not line.startswith("#")}


def wrong(words: List[str]) -> str:
    """What is wrong with one command, or nothing."""
    program = words[0]
    if program == "./do":
        return "" if words[1] in COMMANDS else "./do %s is no command" % words[1]
    if program == "brew":
        return " ".join(name for name in words[2:] if name not in BREW | {"cmake", "ninja"}) if words[1] == "install" \
            else "brew %s" % words[1]
    if program == "build/release/bin/kiln":
        return "" if 'add_executable(kiln_cli' in read("cli/CMakeLists.txt") else program
    for at, word in enumerate(words):
        if word == "--preset" and words[at + 1] not in PRESETS:
            return "there is no preset " + words[at + 1]
        if word == "-D" and words[at + 1].split("=")[0] not in OPTIONS:
            return "there is no option " + words[at + 1]
    return "" if shutil.which(program) else "there is no program " + program


def commands(run: str) -> List[List[str]]:
    lines = [part for line in run.splitlines() for part in line.split("&&")]
    return [shlex.split(line) for line in lines if line.strip()]


def main() -> None:
    text = read(".github/workflows/build.yml")
    jobs = yaml.safe_load(text)["jobs"]
    assert set(jobs) == {"test", "dist", "macos"}, set(jobs)
    assert "was not run" in text
    count = 0
    for name, job in jobs.items():
        assert job["runs-on"] in ("ubuntu-latest", "macos-latest") and 0 < job["timeout-minutes"] <= 120, name
        for step in job["steps"]:
            assert ("run" in step) != ("uses" in step), step
            for words in commands(step.get("run", "")):
                assert not wrong(words), "%s: %s: %s" % (name, " ".join(words), wrong(words))
                count += 1
    assert count >= 10, count
    for planted in ("./do tset", "cmake --preset no", "cmake -D KILN_NO=ON", "brew install nothing", "no-such-program"):
        assert wrong(shlex.split(planted)), planted
    print("%d jobs, %d commands" % (len(jobs), count))


main()
