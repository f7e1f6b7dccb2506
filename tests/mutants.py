#!/usr/bin/env python3
"""Counts the mutants of the libraries and shaders that the tests kill.

  tests/mutants.py [--count 300] [--seed 1] [--build build/mutants] [--folders framegraph/src,...]

A mutant is one source line with one fault: another operator, another constant, a condition that is always
true or false, or a call that is left out. The test programs that the file reaches are built and run, quickest
first, until one fails. A mutant that does not compile is replaced by the next one. The same seed gives the same mutants of the same sources.
The tree must have no uncommitted changes; every file is restored. Prints a line for each mutant and the sum.
"""
import argparse
import pathlib
import random
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = "framegraph/src,framegraph/verifier/src,passes/src,shaders"
# The test programs, quickest first, and the folders whose faults they can see.
PROGRAMS = {"framegraph/framegraph_test": "framegraph", "maths/maths_test": "shaders/maths",
            "framegraph/framegraph_gpu_test": "framegraph", "passes/passes_test": "", "passes/light_passes_test": "",
            "passes/c_interface_test": "", "host/mistakes_test": "passes/src/diagnose",
            "sample/light_test": "sample/render"}
OPERATORS = [(" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" == ", " != "),
             (" != ", " == "), (" && ", " || "), (" || ", " && "), (" + ", " - "), (" - ", " + "),
             (" * ", " / "), (" / ", " * "), (" | ", " & "), ("++", "--"), ("min(", "max("), ("max(", "min(")]


def mutations(line):
    """Returns every mutated form of a line of code."""
    forms = [line[:m.start()] + new + line[m.end():]
             for old, new in OPERATORS for m in re.finditer(re.escape(old), line)]
    for m in re.finditer(r"(?<![\w.])(\d+)(\.\d+)?(?=[fu;,) \]])", line):
        forms.append(line[:m.start(1)] + str(int(m.group(1)) + 1) + line[m.end(1):])
    if m := re.match(r"(\s*(?:\} )?(?:else )?if \()(.*?)(\)(?: \{| return.*;)?\s*)$", line):
        forms += [m.group(1) + value + m.group(3) for value in ("true", "false")]
    if re.match(r"\s+[\w.:>-]+\(.*\);\s*$", line) and "return" not in line:
        forms.append(re.match(r"\s*", line).group() + ";\n")
    return forms


def candidates(folders):
    """Lists (file, line number, mutated line) of all sources, without comments and includes."""
    every = []
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".cpp", ".h", ".comp"):
                continue
            for number, line in enumerate(path.read_text().splitlines(keepends=True)):
                code = line.split("//")[0]
                if code.strip() and not code.lstrip().startswith(("#", "static_assert")):
                    every += [(path, number, text.rstrip("\n") + "\n") for text in mutations(code)]
    return every


def run(command, seconds):
    try:
        return subprocess.run(command, cwd=ROOT, timeout=seconds, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode
    except subprocess.TimeoutExpired:
        return 124


def judge(build, file):
    """Builds and tests a mutant of the file: 'invalid', the name of the program that kills it, or 'SURVIVES'."""
    for program, folder in PROGRAMS.items():
        if not file or file.startswith(folder):
            if run(["ninja", "-C", build, program.split("/")[1]], 1800) != 0:
                return "invalid"
            if run([f"{build}/tests/{program}", "--gtest_brief=1", "--gtest_fail_fast"], 900) != 0:
                return program.split("/")[1]
    return "SURVIVES"


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    options.add_argument("--count", type=int, default=300)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--build", default="build/mutants")
    options.add_argument("--folders", default=FOLDERS)
    arguments = options.parse_args()
    if subprocess.run(["git", "diff", "--quiet", "HEAD"], cwd=ROOT).returncode != 0:
        sys.exit("mutants: the tree has uncommitted changes; commit them first")
    build = str(ROOT / arguments.build)
    if run(["cmake", "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"], 300) != 0 or judge(build, "") != "SURVIVES":
        sys.exit(f"mutants: {arguments.build} cannot be built, or its tests fail without a mutant")
    every = candidates(arguments.folders.split(","))
    random.Random(arguments.seed).shuffle(every)
    valid = killed = 0
    for path, number, text in every:
        if valid == arguments.count:
            break
        original = path.read_text()
        lines = original.splitlines(keepends=True)
        was, lines[number] = lines[number].strip(), text
        try:
            path.write_text("".join(lines))
            verdict = judge(build, str(path.relative_to(ROOT)))
        finally:
            path.write_text(original)
        if verdict != "invalid":
            valid += 1
            killed += verdict != "SURVIVES"
            print(f"{verdict}: {path.relative_to(ROOT)}:{number + 1}: {was} -> {text.strip()}", flush=True)
    print(f"{killed} of {valid} mutants killed (seed {arguments.seed})")


if __name__ == "__main__":
    main()
