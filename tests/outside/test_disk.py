"""A disk that fills up, and checkpoints that are damaged: nothing that was written before is lost."""
import os
import resource
import shutil
import subprocess
import unittest

from calx import FILES, CalxTest, cup, differences


class Disk(CalxTest):
    def case(self):
        return self.write(cup({"/output": {"frames_every": 0.001, "checkpoint_every": 0.004}}))

    def assert_goes_on(self, path, folder):
        """Once there is room, --resume leads to the end of a run that never stopped."""
        self.runs(path, "-o", "straight")
        self.runs(path, "-o", folder, "--resume")
        for name in ("checkpoint.h5", "particles.h5"):
            self.assertEqual(differences(self.dir / "straight" / name, self.dir / folder / name), [])
        self.assertEqual(self.rows("in cup", "straight"), self.rows("in cup", folder))
        self.assertFalse(list((self.dir / folder).rglob("*.partial*")))

    def test_file_size_limit(self):
        path = self.case()

        def limit():
            # Some frames fit into particles.h5, all do not.
            resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))

        result = self.calx("run", path, "-o", "out", preexec_fn=limit)
        line = self.fails(FILES, r"cannot write out/particles\.h5: File too large", "ulimit -f", "what was written before is kept",
                          "last checkpoint at t = ", result=result)
        summary = self.summary("out")
        self.assertEqual(summary["status"], "stopped")
        self.assertTrue(line.startswith("calx: " + summary["reason"]))
        self.assertGreater(summary["time"], 0.004)
        self.assert_goes_on(path, "out")

    @unittest.skipIf(os.geteuid() != 0, "a small file system needs the superuser")
    def test_full_file_system(self):
        small = self.dir / "small"
        small.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=2m", "calx-test", small], check=False,
                          stderr=subprocess.DEVNULL).returncode:
            self.skipTest("file systems cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", small], check=False)
        path = self.case()
        self.fails(FILES, r"cannot write small/out/", "No space left on device", "free some space", "last checkpoint at t = ",
                   result=self.calx("run", path, "-o", "small/out", "--no-report"))
        # Not even summary.json may find room, but what stands there is whole.
        if (small / "out" / "summary.json").exists():
            self.assertIn(self.summary("small/out")["status"], ("stopped", "running"))
        shutil.copytree(small / "out", self.dir / "out")
        self.assert_goes_on(path, "out")

    def test_unwritable_folder(self):
        path = self.case()
        (self.dir / "taken").write_text("a file")
        self.fails(FILES, "taken", "Not a directory|File exists|cannot be made", result=self.calx("run", path, "-o", "taken"))
        self.fails(FILES, "taken/out", "Not a directory|cannot be made", result=self.calx("run", path, "-o", "taken/out"))

    def test_folder_in_use(self):
        path = self.case()
        self.runs(path)
        before = (self.dir / "case.out" / "summary.json").read_text()
        self.fails(FILES, r"case\.out: already holds a run; use --resume to go on, --overwrite to start anew, or -o DIR",
                   result=self.calx("run", path))
        self.assertEqual(before, (self.dir / "case.out" / "summary.json").read_text())
        # Nothing of the earlier run stays, and what is not of Calx does.
        (self.dir / "case.out" / "my notes.txt").write_text("keep me")
        self.runs(path, "--overwrite", "--set", "/output/frames_every=0.02", "--set", "/sensors=[]")
        self.assertEqual(list((self.dir / "case.out" / "series").iterdir()), [])
        self.assertEqual(len(list((self.dir / "case.out" / "frames").glob("particles_*.vtp"))), 4)
        self.assertTrue((self.dir / "case.out" / "my notes.txt").exists())

    def test_resume_without_checkpoint(self):
        path = self.case()
        self.fails(FILES, r"no checkpoint to resume from in \S*case\.out", r"checkpoint\.h5: no such file", "run without --resume",
                   result=self.calx("run", path, "--resume"))
        self.assertFalse((self.dir / "case.out").exists())

    def test_damaged_checkpoint(self):
        path = self.case()
        self.runs(path, "-o", "out", "--until", 0.021)
        newest = self.dir / "out" / "checkpoint.h5"
        whole = newest.read_bytes()
        middle = len(whole) // 2
        damages = {"cut": whole[:middle], "empty": b"", "changed": whole[:middle] + bytes(b ^ 0xFF for b in whole[middle:middle + 64]) + whole[middle + 64:]}
        for name, data in damages.items():
            with self.subTest(name):
                shutil.copytree(self.dir / "out", self.dir / name)
                (self.dir / name / "checkpoint.h5").write_bytes(data)
                result = self.runs(path, "-o", name, "--resume")
                self.assertRegex(result.err, rf"{name}/checkpoint\.h5.*; the checkpoint before it, {name}/checkpoint\.previous\.h5, is used\n")
                self.assertRegex(result.err, r"resumed at t = 0\.02 s|resumed at t = 0\.01999 s")
                self.assertIn("the checkpoint before it", self.summary(name)["notes"][0])
        self.runs(path, "-o", "straight")
        for name in damages:
            self.assertEqual(differences(self.dir / "straight" / "checkpoint.h5", self.dir / name / "checkpoint.h5"), [])
        for name in ("checkpoint.h5", "checkpoint.previous.h5"):
            (self.dir / "cut" / name).write_bytes(damages["cut"])
        self.fails(FILES, "no checkpoint to resume from in cut", r"cut/checkpoint\.h5", r"cut/checkpoint\.previous\.h5",
                   result=self.calx("run", path, "-o", "cut", "--resume"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
