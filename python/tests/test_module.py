"""The module beside what is written of it: types, documents, and how long it takes to import."""

from __future__ import annotations

import ast
import inspect
import json
import statistics
import subprocess
import sys
import unittest
from pathlib import Path

import capsulemap
from capsulemap import _capsulemap

from program import ROOT, environment

STUB = ROOT / "python" / "capsulemap" / "_capsulemap.pyi"


class Written(unittest.TestCase):
    def test_the_stub_tells_all_that_the_module_has(self) -> None:
        tree = ast.parse(STUB.read_text(encoding="utf-8"))
        told: dict[str, ast.AST] = {}
        for node in tree.body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                told[node.name] = node
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                told[node.target.id] = node
        public = {name for name in dir(_capsulemap) if not name.startswith("_")} | {"__version__"}
        self.assertEqual(set(told), public)
        for name, node in told.items():
            if isinstance(node, ast.FunctionDef):
                self.assert_same_arguments(node, getattr(_capsulemap, name), name)
            elif isinstance(node, ast.ClassDef):
                self.assert_same_class(node, getattr(_capsulemap, name))

    def assert_same_class(self, node: ast.ClassDef, own: type) -> None:
        told = {it.name: it for it in node.body if isinstance(it, ast.FunctionDef)}
        public = {name for name in vars(own) if not name.startswith("_")}
        self.assertEqual(set(told), public, node.name)
        for name, method in told.items():
            if any(getattr(it, "id", "") == "property" for it in method.decorator_list):
                self.assertTrue(inspect.isgetsetdescriptor(vars(own)[name]), name)
            else:
                self.assert_same_arguments(method, getattr(own, name), f"{node.name}.{name}")

    def assert_same_arguments(self, node: ast.FunctionDef, own: object, name: str) -> None:
        told = node.args
        names = [it.arg for it in told.posonlyargs + told.args + told.kwonlyargs]
        parameters = inspect.signature(own).parameters  # type: ignore[arg-type]
        self.assertEqual(names, list(parameters), name)
        optional = len(told.defaults) + sum(it is not None for it in told.kw_defaults)
        found = sum(it.default is not inspect.Parameter.empty for it in parameters.values())
        self.assertEqual(optional, found, name)

    def test_every_name_has_a_document(self) -> None:
        for name in capsulemap.__all__:
            own = getattr(capsulemap, name)
            if inspect.isclass(own) or inspect.isfunction(own) or inspect.isbuiltin(own):
                self.assertTrue(inspect.getdoc(own), name)
                for method, value in vars(own).items() if inspect.isclass(own) else ():
                    if inspect.isfunction(value) and not method.startswith("_"):
                        self.assertTrue(inspect.getdoc(value), f"{name}.{method}")

    def test_the_documents_run(self) -> None:
        for name in ("README.md", "names.md"):
            text = (ROOT / "python" / name).read_text(encoding="utf-8")
            blocks = [part.split("```")[0] for part in text.split("```python\n")[1:]]
            self.assertGreater(len(blocks), 2)
            done = run("-W", "error::UserWarning", "-c", "\n".join(blocks), folder=ROOT)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_tutorial_runs_from_top_to_bottom(self) -> None:
        notebook = json.loads((ROOT / "python" / "tutorial.ipynb").read_text(encoding="utf-8"))
        cells = ["".join(it["source"]) for it in notebook["cells"] if it["cell_type"] == "code"]
        self.assertGreater(len(cells), 10)
        done = run("-W", "error::UserWarning", "-c", "\n".join(cells), folder=ROOT / "python")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_import_brings_no_xarray(self) -> None:
        code = (
            "import time; t = time.perf_counter(); import capsulemap; t = time.perf_counter() - t\n"
            "import sys; print(t, 'xarray' in sys.modules, 'numpy' in sys.modules)"
        )
        times = []
        for _ in range(5):
            done = run("-c", code)
            self.assertEqual(done.stdout.split()[1:], ["False", "False"], done.stderr)
            times.append(float(done.stdout.split()[0]))
        print(f"import takes {1e3 * statistics.median(times):.0f} ms", file=sys.stderr)

    def test_the_command_line_has_the_same_version(self) -> None:
        done = run("-m", "capsulemap", "--version")
        self.assertEqual(done.stdout.strip(), f"capsulemap {capsulemap.__version__}")
        self.assertEqual(run("-m", "capsulemap", "sweep").returncode, 2)
        self.assertEqual(run("-m", "capsulemap", "inspect", "nowhere.h5").returncode, 2)


def run(*words: str, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs Python on these words."""
    command = [sys.executable, *words]
    return subprocess.run(
        command, env=environment(), cwd=folder, capture_output=True, text=True, check=False
    )


if __name__ == "__main__":
    unittest.main()
