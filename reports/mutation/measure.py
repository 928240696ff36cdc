#!/usr/bin/env python3
"""Mutation testing: which faults in the solver, contact, constitutive, ledger and gauge modules do the tests notice?

    reports/mutation/measure.py run [--passes unit,quick,all] [arguments of cargo mutants]
    reports/mutation/measure.py collect PASS FOLDER
    reports/mutation/measure.py report

`run` needs cargo-mutants and cargo-nextest. It goes on where the last run ended: a mutant is tried again only if it was missed
or if its file has changed. Each pass runs more tests on what the one before missed; .config/nextest.toml says which.
`report` writes survivors.csv and summary.csv from outcomes.csv and reasons.csv, and fails if a survivor has no reason or a
reason no survivor.
"""

import csv
import hashlib
import json
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
OUT = ROOT / "target" / "mutation"
COLUMNS = ["file", "mutation", "number", "source", "outcome", "pass", "by"]
# Unit tests; rungs of seconds, in the binary of the unit tests; everything.
PASSES = {
    "unit": (["--cargo-arg=--lib"], []),
    "quick": (["--cargo-arg=--lib"], ["--run-ignored=all"]),
    "all": ([], []),
}
CAUGHT = ("caught", "timeout")


def source(file):
    """Fingerprint of a file without its tests."""
    text = (ROOT / file).read_text().split("\n#[cfg(test)]")[0]
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def mutants():
    """All mutants as {name: key}; a key does not change when lines move: file, mutation, number among its like."""
    listing = subprocess.run(["cargo", "mutants", "--list", "--json"], cwd=ROOT, check=True, capture_output=True)
    position = lambda m: (m["file"], m["span"]["start"]["line"], m["span"]["start"]["column"], m["name"])
    seen = Counter()
    keys = {}
    for m in sorted(json.loads(listing.stdout), key=position):
        mutation = m["name"].split(": ", 1)[1]
        seen[m["file"], mutation] += 1
        keys[m["name"]] = (m["file"], mutation, seen[m["file"], mutation])
    return keys


def load():
    """What is known, as {key: row}; rows of files that have changed are forgotten."""
    path = HERE / "outcomes.csv"
    if not path.exists():
        return {}
    rows = list(csv.DictReader(path.open()))
    prints = {file: source(file) for file in {r["file"] for r in rows} if (ROOT / file).exists()}
    rows = [r for r in rows if prints.get(r["file"]) == r["source"]]
    return {(r["file"], r["mutation"], int(r["number"])): r for r in rows}


def store(known):
    with (HERE / "outcomes.csv").open("w") as f:
        writer = csv.DictWriter(f, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(known[key] for key in sorted(known))


def collect(name, folder):
    """Adds what a pass found to outcomes.csv."""
    keys, known = mutants(), load()
    words = {"CaughtMutant": "caught", "MissedMutant": "missed", "Timeout": "timeout", "Unviable": "unviable"}
    for o in json.loads((folder / "outcomes.json").read_text())["outcomes"]:
        mutant = o["scenario"]["Mutant"] if isinstance(o["scenario"], dict) else None
        key = mutant and keys.get(mutant["name"])
        if not key or o["summary"] not in words:
            continue
        outcome, by = words[o["summary"]], ""
        if outcome == "caught":
            log = (folder / o["log_path"]).read_text(errors="replace")
            if fail := re.search(r"^ *(FAIL|TIMEOUT|SIG\w+|ABORT) \[[^\]]*\] *(?:\([^)]*\) )?(\S+ \S+)", log, re.M):
                by = fail[2]
                outcome = "timeout" if fail[1] == "TIMEOUT" else "caught"
        if known.get(key, {}).get("outcome") not in CAUGHT:
            row = (*key, source(key[0]), outcome, name, by.removeprefix("checkdam "))
            known[key] = dict(zip(COLUMNS, row))
    store(known)


def run(arguments):
    passes = list(PASSES)
    if arguments[:1] == ["--passes"]:
        passes, arguments = arguments[1].split(","), arguments[2:]
    for name in passes:
        known, found = load(), OUT / "mutants.out"
        found.mkdir(parents=True, exist_ok=True)
        done = [m for m, key in mutants().items() if known.get(key, {}).get("outcome", "missed") != "missed"]
        (found / "caught.txt").write_text("".join(m + "\n" for m in done))
        for old in ["previously_caught.txt", "unviable.txt", "outcomes.json"]:
            (found / old).unlink(missing_ok=True)
        build, test = PASSES[name]
        environment = {"NEXTEST_PROFILE": f"mutants-{name}", "INSTA_UPDATE": "no"}
        command = ["cargo", "mutants", "--iterate", "--timeout", "1800", "--output", OUT, *build, *arguments]
        subprocess.run([*command, "--", *test], cwd=ROOT, env=os.environ | environment)
        collect(name, found)


def report():
    keys, known = mutants(), load()
    rows = {key: known.get(key) for key in keys.values()}
    reasons = {(r["file"], r["mutation"], int(r["number"])): r for r in csv.DictReader((HERE / "reasons.csv").open())}
    missed = sorted(key for key, row in rows.items() if row and row["outcome"] == "missed")
    with (HERE / "survivors.csv").open("w") as f:
        writer = csv.writer(f, lineterminator="\n")
        writer.writerow(["file", "mutation", "number", "kind", "reason"])
        for key in missed:
            reason = reasons.get(key, {"kind": "", "reason": ""})
            writer.writerow([*key, reason["kind"], reason["reason"]])
    with (HERE / "summary.csv").open("w") as f:
        writer = csv.writer(f, lineterminator="\n")
        header = ["module", "mutants", "not_yet_tried", "unviable", "viable", "caught_by_unit_tests", "caught_by_quick_rungs"]
        writer.writerow([*header, "caught_by_the_rest", "timeout", "missed", "caught_percent", "source_commit"])
        module = lambda key: key[0].removeprefix("src/").removesuffix(".rs").split("/")[0]
        commit = subprocess.run(["git", "log", "-1", "--format=%h", "--", "src"], cwd=ROOT, capture_output=True, text=True)
        for name in [*sorted({module(k) for k in rows}), "all"]:
            own = [row for key, row in rows.items() if name in ("all", module(key))]
            count = Counter((r["outcome"], r["pass"]) if r else ("untried", "") for r in own)
            total = lambda outcome: sum(n for (o, _), n in count.items() if o == outcome)
            viable = len(own) - total("untried") - total("unviable")
            caught = [count["caught", p] for p in PASSES]
            percent = f"{100 * (sum(caught) + total('timeout')) / viable:.1f}" if viable else ""
            cells = [len(own), total("untried"), total("unviable"), viable, *caught, total("timeout"), total("missed")]
            writer.writerow([name, *cells, percent, commit.stdout.strip()])
    problems = [f"no reason: {key}" for key in missed if key not in reasons]
    # A reason may wait for a mutant that has not been tried since its file has changed.
    waits = lambda key: key in rows and rows[key] is None
    problems += [f"a reason, but no survivor: {key}" for key in sorted(reasons) if key not in missed and not waits(key)]
    print((HERE / "summary.csv").read_text(), *problems, sep="\n")
    sys.exit(bool(problems))


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["run", *arguments]:
            run(arguments)
        case ["collect", name, folder]:
            collect(name, Path(folder))
        case ["report"]:
            report()
        case _:
            sys.exit(__doc__)
