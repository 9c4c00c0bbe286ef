"""bad_runs.py CALX BAD_PLUGINS SOURCE: calx run with plugins that misbehave: each is refused, or the run ends with a message and
an exit code of its own, or it lives; and never does a library run because it lies somewhere."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

CALX, BAD, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
CASE = json.loads(re.sub(r"^//.*", "", (SOURCE / "examples/two_balls.json").read_text(), flags=re.M))
CASE["time"]["end"] = 0.002
CASE["sensors"] = []

# Name, exit code (negative: a signal), words of the message.
FORCES = [
    ("good", 0, ""),
    ("counts", 0, ""),
    ("prints", 0, ""),
    ("replaces_forces", 0, ""),
    ("wrong_magic", 4, "it is no Calx plugin"),
    ("other_major", 4, "was built for ABI 2.0"),
    ("small_struct", 4, "has 24 bytes"),
    ("wrong_draft", 4, "was built against draft 7"),
    ("small_table", 4, "rebuild it"),
    ("null_factory", 4, "has no factory"),
    ("null_table", 4, "it has no table"),
    ("null_eval", 4, "lacks eval"),
    ("missing_symbol", 4, "exports no calx_plugin_entry"),
    ("needs_host_symbols", 4, "undefined symbol: calx_internal_function"),
    ("needs_extension", 4, "needs the host extension calx.host.query/1"),
    ("init_fails", 4, "no calibration file"),
    ("create_fails", 4, "out of memory"),
    ("create_nothing", 4, "made no instance"),
    ("create_rejects", 3, "gain = 3 is above 2"),
    ("changes_rounding", 4, "changed the floating-point mode"),
    ("changes_rounding_in_create", 4, "changed the floating-point mode"),
    ("crashes_in_init", 4, "crashed with SIGSEGV (invalid memory access) when it was loaded and initialised"),
    ("crashes_in_create", 4, "crashed with SIGSEGV (invalid memory access) when it made an instance"),
    ("exits_in_create", 4, "ended the process with exit status 0 when it made an instance"),
    ("throws_across", 4, "crashed with SIGABRT"),
    ("exits_in_eval", 4, "a plugin ended the process in the middle of a run"),
    ("aborts_in_eval", -6, "the process crashed in the middle of a run"),
    ("not_finite", 5, ""),
]
LAWS = [
    ("good_law", 0, ""),
    ("other_hash", 4, "SHA-256"),
    ("reads_what_it_did_not_ask_for", -11, "the process crashed in the middle of a run"),
]


def run(folder, case, *options):
    path = folder / "case.json"
    path.write_text(json.dumps(case))
    done = subprocess.run([CALX, "run", str(path), "--threads", "1", "--device", "cpu", "--quiet", "--no-report",
                           "--overwrite", *options], capture_output=True, text=True, cwd=folder, timeout=120, check=False)
    return done.returncode, done.stderr


def case_of(name, law):
    case = json.loads(json.dumps(CASE))
    plugin = "test." + name.replace("_", "-")
    if law:
        case["contacts"] = [{"between": ["glass", "glass"], "law": plugin}]
    else:
        case["forces"] = [{"plugin": plugin}]
    return case


def main():
    faults = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, code, words in FORCES + LAWS:
            got, said = run(folder, case_of(name, (name, code, words) in LAWS), "--plugin-path", str(BAD / name))
            if got != code or words not in said:
                faults.append(f"{name}: exit code {got}, expected {code} and {words!r}; said:\n{said}")
        # The id of a plugin of Calx: the folder searched first wins, and the listing names both.
        listed = subprocess.run([CALX, "plugin", "list", "--plugin-path", str(BAD / "steals_a_name")], capture_output=True,
                                text=True, check=False).stdout
        if "calx.stokes-drag is provided by" not in listed:
            faults.append(f"plugin list does not report the stolen name:\n{listed}")
        # A trap beside the case, which is also the working directory.
        for file in (BAD / "trap").iterdir():
            shutil.copy(file, folder)
        got, said = run(folder, case_of("trap", False))
        if got != 4 or "no plugin test.trap" not in said or (folder / "trap-was-executed").exists():
            faults.append(f"trap beside the case: {got} {said}")
        # Pins: none, the wrong one, the right one.
        case = case_of("good", False)
        got, said = run(folder, case, "--plugin-path", str(BAD / "good"), "--require-pins")
        pin = re.search(r'"plugins": \{"([^"]+)": \{"sha256": "([0-9a-f]{64})"', said)
        if got != 4 or not pin:
            faults.append(f"--require-pins: {got} {said}")
        # A law that is a text may lie beside the case.
        shutil.copy(SOURCE / "examples/third_party_law/spring.law.h", folder)
        (folder / "spring.plugin.json").write_text(json.dumps({
            "calx_plugin": 1, "abi": {"major": 1, "minor": 0}, "version": "1.0.0", "license": "MIT",
            "plugins": [{"id": "org.me.spring", "kind": "calx.contact-law/1", "summary": "A text.",
                         "text": "spring.law.h", "stiffness": ["kn", "kt"]}]}))
        case = case_of("good", False)
        del case["forces"]
        case["contacts"] = [{"between": ["glass", "glass"], "law": "org.me.spring", "parameters": {"kn": 2e4}}]
        got, said = run(folder, case)
        if got != 0:
            faults.append(f"a text beside the case: {got} {said}")
    print("\n".join(faults) or f"{len(FORCES) + len(LAWS)} plugins")
    sys.exit(1 if faults else 0)


main()
