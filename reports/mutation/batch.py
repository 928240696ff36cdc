#!/usr/bin/env python3
"""Mutation testing, many mutants to a binary: the unit tests on all mutants that are missed or have not been tried.

    reports/mutation/batch.py [FILE...]

cargo-mutants lists the mutants. Of each function, the mutated bodies stand beside the original one, and a number in the
environment says which of them runs; so a file is compiled once and not once for each mutant. Mutants outside of functions, in
constant functions and in functions that return an unnamed type other than an iterator are left to `measure.py run`, as is what the
other tests notice.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from collections import defaultdict
from multiprocessing.pool import ThreadPool

from measure import COLUMNS, OUT, ROOT, load, mutants, source, store

TREE = OUT / "tree"
# Mutants to a binary; the kernels are compiled for many shapes, laws and instruction sets, so one of them counts for many.
SIZE = 800
WEIGHT = {"src/transfer/kernels.rs": 25}
# A test that takes so many times the processor time of all tests hangs.
HANGS = 4
# Mutants that are tried at a time.
THREADS = 2
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
OTHERS = ["case::", "check::", "output::", "plot::", "run::", "study::", "scaffold::", "theory::"]
# Tests that take a second or more, in the end.
SLOW = [
    "contact::tests::surfaces::",
    "gauge::reaction::tests::a_clamp_carries",
    "gauge::structure::tests::at_rest",
    "gauge::structure::tests::contact_clamp",
    "simulation::implicit::tests::a_free_swing",
    "simulation::implicit::tests::a_stiff_wall",
]


def refresh():
    """Brings the copy of the project up to date."""
    listing = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True)
    names = listing.stdout.splitlines()
    for old in (TREE / "src").rglob("*.rs"):
        if str(old.relative_to(TREE)) not in names:
            old.unlink()
    for name in names:
        text = (ROOT / name).read_bytes() + (SWITCH.encode() if name == "src/lib.rs" else b"")
        if not (TREE / name).exists() or (TREE / name).read_bytes() != text:
            (TREE / name).parent.mkdir(parents=True, exist_ok=True)
            (TREE / name).write_bytes(text)
            shutil.copymode(ROOT / name, TREE / name)


class File:
    """A source file and the mutants to try in it, as (number, mutant)."""

    def __init__(self, name, listed):
        self.name, self.text = name, (ROOT / name).read_text()
        self.starts = [0]
        for line in self.text.split("\n"):
            self.starts.append(self.starts[-1] + len(line) + 1)
        self.bodies, self.iterators = defaultdict(list), set()
        for number, mutant in listed:
            if body := mutant["function"] and self.body(mutant["function"]):
                span = [self.at(mutant["span"][end]) for end in ("start", "end")]
                self.bodies[body].append((number, mutant, *span))
                if "impl Iterator<" in mutant["function"]["return_type"]:
                    self.iterators.add(body)
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
                unnamed = "impl " in function["return_type"].replace("impl Iterator<", "", 1)
                return None if unnamed or "const fn" in self.text[start:i] else (i, end - 1)
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
            # Iterators of different bodies have different types.
            boxed = (open_brace, close_brace) in self.iterators
            left, right = ("Box::new(", ") as Box<dyn Iterator<Item = _> + '_>,") if boxed else ("", "")
            put(self.text[last:open_brace] + "{ match crate::mutant_switch::number() {\n")
            for number, mutant, start, end in here:
                first = line
                mutated = f"{body[: start - open_brace]}{mutant['replacement']} {body[end - open_brace :]}"
                put(f"{number} => {left}{mutated}{right}\n")
                lines[number] = range(first, line)
            put(f"_ => {left}{body}{right} }} }}")
            last = close_brace + 1
        put(self.text[last:])
        return "".join(out), lines


def build(files):
    """Compiles the tests with all mutants of these files; returns the binary and the mutants that do not compile."""
    wanted, unviable = {n for f in files for n in f.names}, set()
    command = ["cargo", "test", "--no-run", "--package", "checkdam", "--lib", "--profile", "mutants", "--message-format=json"]
    while True:
        taken = {}
        for f in files:
            text, lines = f.generate(wanted)
            (TREE / f.name).write_text(text)
            taken |= {(f.name, line): n for n, own in lines.items() for line in own}
        env = os.environ | {"RUSTFLAGS": "--cap-lints=warn"}
        result = subprocess.run(command, cwd=TREE, env=env, capture_output=True, text=True)
        messages = [json.loads(m) for m in result.stdout.splitlines()]
        if result.returncode == 0:
            return next(m["executable"] for m in messages if m.get("executable")), unviable
        errors = [m["message"] for m in messages if m.get("message", {}).get("level") == "error"]
        places = [(s["file_name"], s["line_start"]) for e in errors for s in e["spans"] if s["is_primary"]]
        bad = {taken[place] for place in places if place in taken}
        if not bad:
            sys.exit("\n".join(["cannot compile", result.stderr, *(e["rendered"] for e in errors)]))
        unviable |= bad
        wanted -= bad


def attempt(binary, number, arguments, limit):
    """Runs tests on one mutant up to the first that fails. On a busy machine an hour may pass: then it has not been tried."""
    shell = f"ulimit -v 8000000 -t {limit}; exec timeout 3600 {binary} --test-threads=1 {' '.join(arguments)}"
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
    if code in (0, 124):
        return "missed" if code == 0 else "untried", ""
    return "timeout" if code in (137, 152, -9, -24) else "caught", test


def rounds(file):
    """Arguments of the tests to run one after the other: quick ones, of the mutant's own module first, then slow ones."""
    module = file.removeprefix("src/").removesuffix(".rs").split("/")[0]
    skip = lambda names: [a for name in names for a in ("--skip", name)]
    return [[f"{module}::", "solver_tests::", *skip(SLOW)], skip(OTHERS + SLOW), SLOW]


def attempt_original(binary, name, seen):
    """Limits of the processor time of each round, s; `seen` keeps those of rounds that files have in common."""
    limits = []
    for arguments in rounds(name):
        if known := seen.get(tuple(arguments)):
            limits.append(known)
            continue
        before = os.times()
        if (outcome := attempt(binary, 0, arguments, 600))[0] != "missed":
            sys.exit(f"{outcome[1]} fails without a mutant")
        limits.append(max(5, int(HANGS * (os.times().children_user - before.children_user))))
        seen[tuple(arguments)] = limits[-1]
    return limits


def trial(binary, number, name, limits):
    outcome = "missed", ""
    for arguments, limit in zip(rounds(name), limits):
        if outcome[0] == "missed":
            outcome = attempt(binary, number, arguments, limit)
    return outcome


def try_batch(batch, keys):
    """Tries mutants, as (number, mutant)."""
    files = [File(f, [m for m in batch if m[1]["file"] == f]) for f in sorted({m["file"] for _, m in batch})]
    (binary, unviable), seen = build(files), {}
    limits = {f.name: attempt_original(binary, f.name, seen) for f in files}
    for f in files:
        (TREE / f.name).write_text(f.text)
        fingerprint = source(f.name)

        def one(number):
            return number, ("unviable", "") if number in unviable else trial(binary, number, f.name, limits[f.name])

        found = []
        with ThreadPool(THREADS) as pool:
            for done, (number, outcome) in enumerate(pool.imap_unordered(one, f.names), 1):
                found.append((number, outcome))
                if done % 20 == 0 or done == len(f.names):
                    known = load()
                    for n, (how, by) in (r for r in found if r[1][0] != "untried"):
                        key = keys[f.names[n]]
                        known[key] = dict(zip(COLUMNS, (*key, fingerprint, how, "unit", by)))
                    store(known)
        missed = sum(outcome == "missed" for _, (outcome, _) in found)
        listed = sum(m["file"] == f.name for _, m in batch)
        print(f"{f.name}: {len(found)} tried, {missed} missed, {listed - len(found)} left to measure.py", flush=True)


def main(files):
    refresh()
    listing = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=ROOT, check=True, capture_output=True)
    keys, known = mutants(), load()
    batch, size = [], 0
    for number, mutant in enumerate(json.loads(listing.stdout), 1):
        open_ = known.get(keys[mutant["name"]], {"outcome": "missed"})["outcome"] == "missed"
        if open_ and (not files or mutant["file"] in files):
            batch.append((number, mutant))
            size += WEIGHT.get(mutant["file"], 1)
            if size >= SIZE:
                try_batch(batch, keys)
                batch, size = [], 0
    if batch:
        try_batch(batch, keys)


if __name__ == "__main__":
    main(sys.argv[1:])
