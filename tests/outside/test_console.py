"""What a run says while it goes: on a terminal, into a file, as JSON lines, and nothing when asked."""
import json
import os
import pty
import re
import select
import signal
import subprocess
import time
import unittest

from calx import CALX, CASE, FILES, CalxTest, cup


class Console(CalxTest):
    def long_case(self, end=100):
        """Goes on for minutes unless it is stopped."""
        return self.write(cup({"/time/end": end, "/output": {"checkpoint_every_wall": 0.3}}))

    def on_terminal(self, *words, until):
        """Standard error of calx as a terminal gets it, until that pattern stands in it; then Ctrl-C."""
        ours, theirs = pty.openpty()
        process = subprocess.Popen([CALX, "run", *map(str, words)], cwd=self.dir, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        text, limit, stopped = "", time.monotonic() + 60, False
        while time.monotonic() < limit:
            if select.select([ours], [], [], 0.1)[0]:
                try:
                    data = os.read(ours, 4096)
                except OSError:  # the other end is closed
                    break
                if not data:
                    break
                text += data.decode()
            if not stopped and re.search(until, text):
                process.send_signal(signal.SIGINT)
                stopped = True
        os.close(ours)
        if process.poll() is None and time.monotonic() >= limit:
            process.kill()
        return process.wait(), text

    def test_terminal(self):
        code, text = self.on_terminal(self.long_case(), "-o", "out", until=r"(?s)left.*left.*left")
        self.assertEqual(code, 130, text)
        lines = text.split("\r\x1b[K")
        progress = [line for line in lines if " left" in line]
        self.assertGreaterEqual(len(progress), 3)
        for line in progress:
            self.assertRegex(line, r"^t = \d+\.\d{4} of 100 s +\d+ %  60 particles  \d+\.\d\d M particle-steps/s  .* (s|min|h) left$")
            self.assertLess(len(line), 100)
        # The line is cleared before the last words.
        self.assertRegex(text, r"\r\x1b\[Kreport: out/report\.html\r\ncalx: interrupted at t = ")
        self.assertTrue(text.endswith("go on with --resume\r\n"), text[-200:])

    def test_lines(self):
        path = self.write(cup())
        result = self.calx("run", path)
        self.assertEqual(result.code, 0)
        self.assertEqual(result.out, "")
        self.assertNotRegex(result.err, "[\r\x1b]")
        lines = result.err.split("\n")
        self.assertRegex(lines[0], r'^t = 0\.0000 s: source "pour" has delivered 0\.005027 kg of 0\.005027 kg \(60 particles\)$')
        self.assertRegex(lines[-3], r"^done: t = (0\.05|0\.04999|0\.05001) s, \d+ steps, 60 particles, [\d.]+ s of wall time, \S+ M particle-steps/s$")
        self.assertRegex(lines[-2], r"^report: \S*case\.out/report\.html$")
        self.assertLessEqual(len(lines), 5)  # some progress where the machine is slow
        # The log holds the same, with times.
        log = (self.dir / "case.out" / "run.log").read_text().split("\n")
        self.assertRegex(log[0], r'^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z info t = 0\.0000 s: source "pour"')
        self.assertRegex(log[-2], r"Z info done: t = ")

    def test_quiet(self):
        result = self.calx("run", self.write(cup()), "--quiet")
        self.assertEqual((result.code, result.out, result.err), (0, "", ""))
        self.fails(FILES, "already holds a run", result=self.calx("run", "case.json", "--quiet"))

    def json_lines(self, result):
        return [json.loads(line) for line in result.err.splitlines()]

    def test_json(self):
        path = self.write(cup({"/title": 'a "quoted" title', "/time/end": 0.2}))
        result = self.calx("run", path, "--json", "--threads", 1)
        self.assertEqual((result.code, result.out), (0, ""))
        lines = self.json_lines(result)
        self.assertEqual({line["event"] for line in lines} - {"progress"}, {"message"})
        messages = [line["message"] for line in lines if line["event"] == "message"]
        self.assertIn('source "pour" has delivered', messages[0])
        self.assertRegex(messages[-2], "^done: t = 0.2 s")
        # An error is a line as well.
        result = self.calx("run", path, "--json")
        self.assertEqual(result.code, FILES)
        line, = self.json_lines(result)
        self.assertEqual((line["event"], line["exit_code"]), ("error", FILES))
        self.assertIn("already holds a run", line["message"])
        result = self.calx("run", path, "--json", "--set", "/time/ende=1")
        self.assertEqual(self.json_lines(result)[0]["exit_code"], CASE)

    def test_json_progress(self):
        process = subprocess.Popen([CALX, "run", str(self.long_case()), "--json"], cwd=self.dir, stderr=subprocess.PIPE, text=True)
        lines = []
        for text in process.stderr:
            lines.append(json.loads(text))
            if lines[-1]["event"] == "progress":
                process.send_signal(signal.SIGTERM)
        process.stderr.close()
        self.assertEqual(process.wait(60), 130)
        progress = next(line for line in lines if line["event"] == "progress")
        self.assertEqual(progress.keys(), {"event", "time", "end", "share", "particles", "particle_steps_per_second", "seconds_left"})
        self.assertEqual((progress["end"], progress["particles"]), (100, 60))
        self.assertAlmostEqual(progress["share"], progress["time"] / 100, delta=1e-4)
        self.assertGreater(progress["seconds_left"], 0)
        self.assertEqual((lines[-1]["event"], lines[-1]["exit_code"]), ("error", 130))

    def test_report_of_a_running_run(self):
        process = subprocess.Popen([CALX, "run", str(self.long_case()), "-o", "out", "--quiet", "--threads", "1"], cwd=self.dir,
                                   stderr=subprocess.DEVNULL)
        try:
            limit = time.monotonic() + 60
            while not (self.dir / "out" / "summary.json").exists():
                self.assertIsNone(process.poll())
                self.assertLess(time.monotonic(), limit, "no summary.json within a minute")
                time.sleep(0.05)
            self.assertEqual(self.summary("out")["status"], "running")
            result = self.calx("report", "out")
            self.assertEqual((result.code, result.out, result.err), (0, "out/report.html\n", ""))
            page = (self.dir / "out" / "report.html").read_text()
            self.assertIn("balls in a cup", page)
            self.assertIn("running", page)
            self.assertIsNone(process.poll(), "the run ended while its report was written")
            self.fails(FILES, "already holds a run", result=self.calx("run", "case.json", "-o", "out"))
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted", (self.dir / "out" / "report.html").read_text())

    def test_report_of_a_finished_run(self):
        self.runs(self.write(cup()), "-o", "out")
        self.assertFalse((self.dir / "out" / "report.html").exists())
        result = self.calx("report", "out")
        self.assertEqual((result.code, result.out), (0, "out/report.html\n"))
        page = (self.dir / "out" / "report.html").read_text()
        for text in ("balls in a cup", "in cup", "every value is made up", "calx.hertz-mindlin"):
            self.assertIn(text, page)
        self.assertNotRegex(page, r'(src|href)="https?://')
        self.fails(FILES, "none is not a folder", "-o of calx run", result=self.calx("report", "none"))
        (self.dir / "empty").mkdir()
        self.fails(FILES, "empty: holds no run", result=self.calx("report", "empty"))
        self.assertEqual(list((self.dir / "empty").iterdir()), [])

    def test_report_of_a_diagnosis(self):
        folder = self.dir / "found"
        folder.mkdir()
        (folder / "diagnosis.json").write_text('{"verdict": "none", "title": "a valve"}')
        result = self.calx("report", "found")
        self.assertEqual((result.code, result.out, result.err), (0, "found/report.html\n", ""))
        page = (folder / "report.html").read_text()
        self.assertIn("Nothing is shown to be wrong", page)
        self.assertNotRegex(page, r'(src|href)="https?://')
        (folder / "diagnosis.json").write_text('{"verdict": ')
        self.fails(FILES, "found/diagnosis.json: is no valid JSON", result=self.calx("report", "found"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
