"""score.py: verdicts against sealed truths: what counts as right, and the table with binomial intervals."""
import json
import math

OUTCOMES = ("right", "in group", "half", "undecided", "missed", "unknown", "wrong", "quiet", "flagged", "false name")


def outcome(truth, verdict, named, left):
    """One word for a verdict. left: the 95 % set.

    Of an effect: right: it alone is named; in group: no name, and it is among at most three causes left, "nothing" is not;
    undecided: no name, and other things are left, too; missed: nothing is said to be wrong; unknown: something outside the
    library is said; wrong: something else is named. Of a pair, right: both, half: one of both. Of a control, quiet: no name
    and nothing outside the library; of what is outside the library, flagged: said so."""
    causes = tuple(truth["truth"])
    if truth["kind"] == "control":
        return "false name" if named else "unknown" if verdict == "unknown" else "quiet"
    if truth["kind"] == "outside":
        return "false name" if named else {"unknown": "flagged", "none": "missed"}.get(verdict, "undecided")
    if truth["kind"] == "pair":
        if named:
            return "wrong" if not named <= set(causes) else "right" if named == set(causes) else "half"
    elif named:
        return "right" if len(named) == 1 and named <= set(causes) else "wrong"
    if verdict in ("none", "unknown"):
        return {"none": "missed", "unknown": "unknown"}[verdict]
    return "in group" if left & set(causes) and "none" not in left and len(left - {"unknown"}) <= 3 else "undecided"


def score(folder):
    truth = json.loads((folder / "sealed" / "truth.json").read_text(encoding="ascii"))
    d = json.loads((folder / "diagnosis" / "diagnosis.json").read_text(encoding="utf-8"))
    named = {c["id"] for c in d["causes"] if c["named"]}
    left = {s.split(" ")[0] for s in d["set"]}
    true = [c for c in d["causes"] if c["id"] in truth["truth"]]
    best = max(true, key=lambda c: c["evidence"]) if true else None
    s = {"name": truth["name"], "rig": truth["rig"], "kind": truth["kind"], "truth": truth["truth"],
         "outcome": outcome(truth, d["verdict"], named, left), "verdict": d["verdict"], "named": sorted(named),
         "set": d["set"], "runs": d["runs"]["used"], "delta": best["signal_to_noise"] if best else None,
         "evidence": best["evidence"] if best else None, "reason": d["reason"]}
    delta = f", delta {s['delta']:.1f}, evidence {s['evidence']:.3f}" if best else ""
    s["line"] = f"{s['outcome']}: {d['verdict']} {' + '.join(s['named'])}{delta}; set {', '.join(d['set'])}; {s['runs']} runs"
    return s


def interval(hits, n, level=0.95):
    """Of Clopper and Pearson (1934): the shares at which a tail of the binomial has (1 - level) / 2."""
    def below(p, k):
        return sum(math.comb(n, i) * p**i * (1 - p) ** (n - i) for i in range(k + 1))

    def solve(f):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if f(middle) else (low, middle)
        return low
    tail = (1 - level) / 2
    return (0.0 if hits == 0 else solve(lambda p: 1 - below(p, hits - 1) < tail),
            1.0 if hits == n else solve(lambda p: below(p, hits) > tail))


def share(text, hits, n):
    low, high = interval(hits, n)
    return f"| {text} | {hits} of {n} | {100 * low:.0f} to {100 * high:.0f} % |"


def table(scores):
    """Studies, confusion and shares, as Markdown."""
    lines = ["| study | rig | hidden | verdict | named, or left | delta | runs | |", "|---|---|---|---|---|---|---|---|"]
    for s in scores:
        left = ", ".join(s["set"]) if len(s["set"]) < 5 else f"{len(s['set'])} explanations"
        said = " + ".join(s["named"]) or left
        hidden = s["truth"][0] if s["kind"] == "effect" else " + ".join(s["truth"]) or s["kind"]
        delta = f"{s['delta']:.1f}" if s["delta"] is not None else ""
        lines.append(f"| {s['name']} | {s['rig']} | {hidden} | {s['verdict']} | {said.replace('calx.', '')} | {delta} | "
                     f"{s['runs']} | {s['outcome']} |")
    kinds = [k for k in ("effect", "pair", "outside", "control") if any(s["kind"] == k for s in scores)]
    seen = [o for o in OUTCOMES if any(s["outcome"] == o for s in scores)]
    lines += ["", "| | " + " | ".join(seen) + " |", "|---" * (len(seen) + 1) + "|"]
    for kind in kinds:
        counts = [sum(s["kind"] == kind and s["outcome"] == o for s in scores) for o in seen]
        lines.append(f"| {kind} | " + " | ".join(map(str, counts)) + " |")
    lines += ["", "| | | 95 % interval |", "|---|---|---|"]
    of = {k: [s["outcome"] for s in scores if s["kind"] == k] for k in kinds}
    if "effect" in of:
        effects = of["effect"]
        found = sum(o in ("right", "in group") for o in effects)
        lines.append(share("effect right or in group", found, len(effects)))
        lines.append(share("effect named right", effects.count("right"), len(effects)))
        lines.append(share("effect named wrongly", effects.count("wrong"), len(effects)))
    if "control" in of:
        lines.append(share("control with a name", of["control"].count("false name"), len(of["control"])))
    if "outside" in of:
        lines.append(share("outside the library, named as something", of["outside"].count("false name"), len(of["outside"])))
    return "\n".join(lines) + "\n"
