"""gpu_rows.py: rows, tables and comparisons for gpu_all.sh. Needs nothing but Python; h5py only to name what differs."""
import argparse
import datetime
import hashlib
import json
import pathlib
import statistics
import struct
import sys

import machine

BLOCK = 4096


def runs_on(text, asked):
    """Whether a device's description is of the kind asked for: a run that fell back to the processor proves nothing."""
    return text.startswith(asked.split(":")[0]) and not text.startswith("cpu, because")


def checked_device(text, asked):
    if not runs_on(text, asked):
        sys.exit(f"asked for {asked}, ran on {text}")


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def differ_in_times_only(a, b):
    """HDF5 keeps with each data set when it was made, as 32-bit seconds: whether two files are the same but for these."""
    left, right = a.read_bytes(), b.read_bytes()
    if len(left) != len(right):
        return False

    def written(data, at, path):
        value = struct.unpack_from("<I", data, at)[0]
        return -600 <= value - path.stat().st_mtime <= 2

    passed = 0
    for first in range(0, len(left), BLOCK):
        if left[first:first + BLOCK] == right[first:first + BLOCK]:
            continue
        for k in range(max(first, passed), min(first + BLOCK, len(left))):
            if left[k] == right[k] or k < passed:
                continue
            at = next((s for s in range(max(0, k - 3), min(k, len(left) - 4) + 1)
                       if written(left, s, a) and written(right, s, b)), None)
            if at is None:
                return False
            passed = at + 4
    return True


def differences_inside(a, b):
    """Names of data sets of two HDF5 files that differ in a bit, where h5py is there to look; else no names."""
    try:
        import h5py  # pylint: disable=import-outside-toplevel
    except ImportError:
        return [a.name]

    def contents(path):
        found = {}
        with h5py.File(path, "r") as file:
            def visit(name, item):
                if isinstance(item, h5py.Dataset):
                    value = item[()]
                    found[name] = value.tobytes() if hasattr(value, "tobytes") else value
            file.visititems(visit)
        return found

    left, right = contents(a), contents(b)
    return [f"{a.name}:{name}" for name in sorted(set(left) | set(right)) if left.get(name) != right.get(name)] or [a.name]


def same(options):
    a, b = pathlib.Path(options.a), pathlib.Path(options.b)
    summary = json.loads((b / "summary.json").read_text())
    checked_device(summary["provenance"]["device"], options.device)
    series = sorted(path.name for path in (a / "series").iterdir())
    if not series or series != sorted(path.name for path in (b / "series").iterdir()):
        sys.exit(f"series of {a}: {series}, of {b}: others")
    bad = [f"series/{name}" for name in series if digest(a / "series" / name) != digest(b / "series" / name)]
    how = f"{len(series)} series"
    for name in ("checkpoint.h5", "particles.h5"):
        if not (a / name).exists() or not (b / name).exists():
            bad.append(f"{name} (missing)")
        elif differ_in_times_only(a / name, b / name):
            how += f", {name}"
        else:
            bad += differences_inside(a / name, b / name)
    if bad:
        sys.exit(f"not the same bits: {', '.join(bad[:8])}{' ...' if len(bad) > 8 else ''} ({len(bad)} in all)")
    print(f"same bits: {how}; sha256 of {series[0]} {digest(a / 'series' / series[0])[:16]}")


def write(options, result):
    files = [pathlib.Path(options.out) / "rows.jsonl"]
    if options.results:
        files.append(pathlib.Path(options.results) / f"{options.machine}.jsonl")
    for path in files:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path, "a", encoding="ascii") as lines:
            lines.write(json.dumps(result) + "\n")


def row(options):
    result = {"time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"), "machine": options.machine,
              "round": 0, "case": options.case, "code": "calx"}
    if options.run:
        s = json.loads((pathlib.Path(options.run) / "summary.json").read_text())
        where = s["provenance"]["device"]
        found = {"device": where, "threads": s["provenance"]["threads"], "particles": s["particles"]["count"]
                 if isinstance(s.get("particles"), dict) else s.get("particles"), "wall_s": s["wall_seconds"],
                 "rate": s["particle_steps_per_second"], "status": s.get("status"), "time_s": s.get("time"),
                 "version": f"Calx {s['provenance']['calx']} ({s['provenance']['git']})"}
        text = f"t = {found['time_s']:.6g} s, {found['status']}"
    else:
        lines = [line for line in pathlib.Path(options.log).read_text().splitlines() if line.startswith("{")]
        if len(lines) != 1:
            sys.exit(f"{options.log}: {len(lines)} rows where one was expected")
        c = json.loads(lines[0])
        where = c["device"]
        found = {"device": where, "threads": c["threads"], "particles": c["particles"], "steps": c["steps"],
                 "warm_up": options.warm_up, "wall_s": c["wall_s"], "rate": c["particle_steps_per_second"],
                 "version": f"Calx {c['calx']} ({c['git']})", "calx": c}
        text = f"{c['ns_per_contact']} ns per contact, {c['bytes_per_sphere']} B per sphere"
    checked_device(where, options.device)
    result.update(found, asked=options.device)
    write(options, result)
    print(f"{found['rate'] / 1e6:.3f} M particle-steps/s, {text}")


def table(options):
    path = pathlib.Path(options.out) / "rows.jsonl"
    cells = {}
    for line in path.read_text().splitlines() if path.exists() else []:
        result = json.loads(line)
        if "calx" in result:
            cells.setdefault((result["case"], result["asked"]), []).append(result)
    print("| case | on | particles | M particle-steps/s | over cpu | ns per contact | bytes per sphere | lists, share |")
    print("|---|---|---|---|---|---|---|---|")
    for (case, asked), results in cells.items():
        rate = statistics.median(r["rate"] for r in results)
        cpu = cells.get((case, "cpu"))
        over = f"{rate / statistics.median(r['rate'] for r in cpu):.2f}" if cpu and asked != "cpu" else ""
        last = results[-1]
        c = last["calx"]
        on = f"cpu, {last['threads']} threads" if asked == "cpu" else asked
        print(f"| {case} | {on} | {last['particles']} | {rate / 1e6:.2f} | {over} | {c['ns_per_contact']} | "
              f"{c['bytes_per_sphere']} | {c['share_neighbour']} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    verbs = parser.add_subparsers(required=True)
    verbs.add_parser("machine").set_defaults(verb=lambda _: print(machine.gpu_machine_name()))
    verb = verbs.add_parser("same")
    verb.add_argument("a")
    verb.add_argument("b")
    verb.add_argument("--device", required=True)
    verb.set_defaults(verb=same)
    verb = verbs.add_parser("row")
    for name in ("out", "machine", "case", "device"):
        verb.add_argument(f"--{name}", required=True)
    for name in ("results", "log", "run"):
        verb.add_argument(f"--{name}", default="")
    verb.add_argument("--warm-up", type=int, default=0)
    verb.set_defaults(verb=row)
    verb = verbs.add_parser("table")
    verb.add_argument("--out", required=True)
    verb.set_defaults(verb=table)
    options = parser.parse_args()
    options.verb(options)


if __name__ == "__main__":
    main()
