"""Texts of help(), and the examples in them and in the guide."""
# SPDX-License-Identifier: LGPL-3.0-or-later
import doctest
import inspect
import os
import re
import tempfile
import unittest
from typing import Any, Iterator

import numpy as np

import incise
import support

NAMES = {"incise": incise, "np": np}


def members() -> Iterator[tuple[str, Any]]:
    """Return all public names of the module with what they name."""
    yield "incise", incise
    for name in incise.__all__:
        thing = getattr(incise, name)
        if name == "__version__":
            continue
        yield name, thing
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for inner, member in vars(thing).items():
                if not inner.startswith("_") or (inner == "__init__" and name in
                                                 ("World", "Mesh", "Pose")):
                    yield f"{name}.{inner}", member


class Texts(unittest.TestCase):
    def test_every_public_name_has_one(self) -> None:
        bare = []
        for name, thing in members():
            text = re.sub(r"^(\w+\(.*\) -> .*|Overloaded function.*)$", "",
                          inspect.getdoc(thing) or "", flags=re.M).strip()
            if len(text) < 10:
                bare.append(name)
        self.assertEqual(bare, [])

    def test_names_are_those_of_the_package(self) -> None:
        for name in incise.__all__:
            thing = getattr(incise, name)
            if inspect.isclass(thing):
                self.assertEqual(thing.__module__, "incise", name)
        self.assertNotIn("_incise.", incise.World.step.__doc__ or "")

    def test_lines_are_short(self) -> None:
        for name, thing in members():
            for line in (inspect.getdoc(thing) or "").splitlines():
                if "->" not in line:
                    self.assertLessEqual(len(line), 100, f"{name}: {line}")

    def test_examples_in_the_texts(self) -> None:
        finder, runner = doctest.DocTestFinder(exclude_empty=True), doctest.DocTestRunner()
        names = set()
        for name, thing in members():
            if isinstance(thing, staticmethod):
                thing = thing.__func__
            for test in finder.find(thing, name, module=False, globs=dict(NAMES)):
                if test.name not in names:
                    names.add(test.name)
                    runner.run(test)
        self.assertEqual(runner.failures, 0)
        self.assertGreater(runner.tries, 15)

    def test_examples_of_the_guide(self) -> None:
        """The blocks of docs/python.md run one after the other in one session."""
        guide = support.SOURCES / "docs" / "python.md"
        text = guide.read_text()
        blocks = re.findall(r"^```python\n(.*?)^```$", text, flags=re.M | re.S)
        self.assertGreater(len(blocks), 8)
        # What has no prompt is run as it is; it may show what it needs and prints.
        examples: list[str] = []
        for block in blocks:
            if ">>>" in block:
                examples.append(block)
                continue
            lines = block.rstrip("\n").split("\n")
            prompts = []
            for line in lines:
                is_inside = line.startswith((" ", ")", "]", "}", "else", "except", "finally"))
                prompts.append(("... " if is_inside or not line else ">>> ") + line)
            examples.append("\n".join(prompts) + "\n")
        os.environ.setdefault("MPLBACKEND", "Agg")
        test = doctest.DocTestParser().get_doctest("\n".join(examples), dict(NAMES), "python.md",
                                                   str(guide), 0)
        runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
        before = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            os.symlink(support.SOURCES / "data", "data")
            os.symlink(support.SOURCES / "examples", "examples")
            try:
                runner.run(test)
            finally:
                os.chdir(before)
        self.assertEqual(runner.failures, 0)


if __name__ == "__main__":
    unittest.main()
