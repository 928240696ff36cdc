#!/usr/bin/env python3
"""Mutation testing, many mutants to a binary: the unit tests on all mutants that are missed or have not been tried.

    reports/mutation/batch.py [FILE...]

cargo-mutants lists the mutants. Of each function, the mutated bodies stand beside the original one, and a number in the
environment says which of them runs; so a file is compiled once and not once for each mutant. Mutants outside of functions, in
constant functions and in functions that return an unnamed type are left to `measure.py run`, as is what the other tests notice.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections import defaultdict

from measure import COLUMNS, OUT, ROOT, load, mutants, source, store

TREE = OUT / "tree"
# Mutants to a binary; the kernels are compiled for many shapes, laws and instruction sets.
SIZE = {"src/transfer/kernels.rs": 30}
# A test that takes so many times the processor time of all tests hangs.
HANGS = 8
SWITCH = """
#[allow(missing_docs)]
pub mod mutant_switch {
    static MUTANT: std::sync::LazyLock<u32> =
        std::sync::LazyLock::new(|| std::env::var("MUTANT").map_or(0, |m| m.parse().expect("a number")));
    pub fn number() -> u32 {
        *MUTANT
    }
}
"""
OTHERS = ["case::", "check::", "output::", "plot::", "run::", "theory::", "verification::"]


def refresh():
    """Brings the copy of the project up to date."""
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, names):
        text = (ROOT / name).read_bytes() + (SWITCH.encode() if name == "src/lib.rs" else b"")
        if not (TREE / name).exists() or (TREE / name).read_bytes() != text:
            (TREE / name).parent.mkdir(parents=True, exist_ok=True)
            (TREE / name).write_bytes(text)
            shutil.copymode(ROOT / name, TREE / name)


class File:
    """A source file and the mutants to try in it."""

    def __init__(self, name, listed):
        self.name, self.text = name, (ROOT / name).read_text()
        self.starts = [0]
        for line in self.text.split("\n"):
            self.starts.append(self.starts[-1] + len(line) + 1)
        self.bodies = defaultdict(list)
        for number, mutant in enumerate(listed, 1):
            if body := mutant["function"] and self.body(mutant["function"]):
                span = [self.at(mutant["span"][end]) for end in ("start", "end")]
                self.bodies[body].append((number, mutant, *span))
        # A function within a function that has mutants of its own.
        for inner in [b for b in self.bodies if any(o[0] < b[0] and b[1] < o[1] for o in self.bodies)]:
            del self.bodies[inner]
        self.names = {number: m["name"] for body in self.bodies.values() for number, m, *_ in body}

    def at(self, place):
        return self.starts[place["line"] - 1] + place["column"] - 1

    def body(self, function):
        """Where the braces of its body are."""
        start, end = self.at(function["span"]["start"]), self.at(function["span"]["end"])
        depth = 0
        for i in range(start, end):
            depth += (self.text[i] in "([") - (self.text[i] in ")]")
            if self.text[i] == "{" and depth == 0:
                plain = "const fn" not in self.text[start:i] and "impl " not in function["return_type"]
                return (i, end - 1) if plain else None
        return None

    def generate(self, wanted):
        """The source with these mutants, and the lines that each takes."""
        out, last, line, lines = [], 0, 1, {}

        def put(text):
            nonlocal line
            out.append(text)
            line += text.count("\n")

        for (open_brace, close_brace), all_here in sorted(self.bodies.items()):
            here = [m for m in all_here if m[0] in wanted]
            if not here:
                continue
            body = self.text[open_brace : close_brace + 1]
            put(self.text[last:open_brace] + "{ match crate::mutant_switch::number() {\n")
            for number, mutant, start, end in here:
                first = line
                put(f"{number} => {body[: start - open_brace]}{mutant['replacement']} {body[end - open_brace :]}\n")
                lines[number] = range(first, line)
            put(f"_ => {body} }} }}")
            last = close_brace + 1
        put(self.text[last:])
        return "".join(out), lines

    def build(self, wanted):
        """Compiles the tests with these mutants; returns the binary, the mutants in it, and those that do not compile."""
        wanted, unviable = set(wanted), set()
        command = ["cargo", "test", "--no-run", "--lib", "--profile", "mutants", "--message-format=json"]
        while True:
            text, lines = self.generate(wanted)
            (TREE / self.name).write_text(text)
            env = os.environ | {"RUSTFLAGS": "--cap-lints=warn"}
            result = subprocess.run(command, cwd=TREE, env=env, capture_output=True, text=True)
            messages = [json.loads(m) for m in result.stdout.splitlines()]
            if result.returncode == 0:
                return next(m["executable"] for m in messages if m.get("executable")), wanted, unviable
            errors = [m["message"] for m in messages if m.get("message", {}).get("level") == "error"]
            places = [s["line_start"] for e in errors for s in e["spans"] if s["is_primary"] and s["file_name"] == self.name]
            bad = {n for n, taken in lines.items() if any(p in taken for p in places)}
            if not bad:
                sys.exit("\n".join([f"cannot compile {self.name}", result.stderr, *(e["rendered"] for e in errors)]))
            unviable |= bad
            wanted -= bad


def attempt(binary, number, arguments, limit):
    """Runs tests on one mutant up to the first that fails."""
    shell = f"ulimit -v 8000000 -t {limit}; exec timeout -s KILL 600 {binary} --test-threads=1 {' '.join(arguments)}"
    env = os.environ | {"MUTANT": str(number), "RUST_BACKTRACE": "0", "INSTA_UPDATE": "no"}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    run, test = subprocess.Popen(["bash", "-c", shell], cwd=TREE, env=env, text=True, errors="replace", **pipes), ""
    for line in run.stdout:
        if found := re.match(r"test (\S+) \.\.\.", line):
            test = found[1]
        if line.endswith("FAILED\n") and found:
            run.kill()
            run.wait()
            return "caught", test
    code = run.wait()
    if code == 0:
        return "missed", ""
    return "timeout" if code in (137, 152, -9, -24) else "caught", test


def trial(binary, number, file, limit):
    """The tests of the mutant's own module first."""
    module = file.removeprefix("src/").removesuffix(".rs").split("/")[0]
    own = [f"{module}::", "solver_tests::"]
    outcome = attempt(binary, number, own, limit)
    rest = [a for other in OTHERS for a in ("--skip", other)]
    return attempt(binary, number, rest, limit) if outcome[0] == "missed" else outcome


def try_file(name, listed):
    file, found = File(name, listed), {}
    numbers = sorted(file.names)
    size = SIZE.get(name, 400)
    for k in range(0, len(numbers), size):
        binary, viable, unviable = file.build(numbers[k : k + size])
        before = os.times()
        if (original := trial(binary, 0, name, 600))[0] != "missed":
            sys.exit(f"{name}: {original[1]} fails without a mutant")
        after = os.times()
        limit = max(10, int(HANGS * (after.children_user - before.children_user)))
        found |= {n: ("unviable", "") for n in unviable} | {n: trial(binary, n, name, limit) for n in sorted(viable)}
    (TREE / name).write_text(file.text)
    return {file.names[n]: outcome for n, outcome in found.items()}


def main(files):
    refresh()
    listing = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=ROOT, check=True, capture_output=True)
    keys, known, todo = mutants(), load(), defaultdict(list)
    for mutant in json.loads(listing.stdout):
        open_ = known.get(keys[mutant["name"]], {"outcome": "missed"})["outcome"] == "missed"
        if open_ and (not files or mutant["file"] in files):
            todo[mutant["file"]].append(mutant)
    for name, listed in todo.items():
        found, known = try_file(name, listed), load()
        for mutant, (outcome, by) in found.items():
            key = keys[mutant]
            known[key] = dict(zip(COLUMNS, (*key, source(name), outcome, "unit", by)))
        store(known)
        missed = sum(outcome == "missed" for outcome, _ in found.values())
        print(f"{name}: {len(found)} tried, {missed} missed, {len(listed) - len(found)} left to measure.py", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
