"""machine.py: what a row of results says about the machine. Needs nothing but Python."""
import os
import pathlib
import re
import subprocess
import time


def busy_seconds():
    """CPU seconds of the whole machine that were not idle."""
    fields = [int(word) for word in pathlib.Path("/proc/stat").read_text().split("\n")[0].split()[1:]]
    return (sum(fields[:8]) - fields[3] - fields[4]) / os.sysconf("SC_CLK_TCK")


def wait_until_quiet(limit):
    """Waits until less than 0.15 of one processor is busy, at most limit seconds; returns what was busy last."""
    end, load = time.monotonic() + limit, 0.0
    while True:
        before = busy_seconds()
        time.sleep(1.0)
        load = busy_seconds() - before
        if load < 0.15 or time.monotonic() > end:
            return load


def slug(text):
    return re.sub(r"[^a-z0-9]+", "-", text.lower()).strip("-")


def machine_name():
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    model = re.search(r"^model name\s*:\s*(.*)$", text, re.M)
    words = re.sub(r"\((R|TM)\)|CPU|@.*", "", model[1] if model else "unknown")
    return slug(words) + f"-{os.cpu_count()}"


def gpu_machine_name():
    """The processor, and the first NVIDIA GPU where the driver lists one."""
    try:
        done = subprocess.run(["nvidia-smi", "--query-gpu=name", "--format=csv,noheader"], capture_output=True, text=True,
                              timeout=60, check=False)
        gpu = done.stdout.splitlines()[0] if done.returncode == 0 and done.stdout.strip() else ""
    except (OSError, subprocess.TimeoutExpired):
        gpu = ""
    return machine_name() + (f"-{slug(gpu)}" if gpu else "")
