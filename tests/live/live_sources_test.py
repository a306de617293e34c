"""Tests that the engine of the live page must be rebuilt after a change of code, but not after a change of comments.

    python3 live_sources_test.py SOURCE
"""

import pathlib
import sys
import unittest

SOURCE = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else ".")
sys.path.insert(0, str(SOURCE / "tools" / "lib"))
from live_sources import code_of  # noqa: E402

CODE = 'int a = 1\'000;\nf("// text", \'"\', R"(/* raw "text" */)");\n'


class CodeOf(unittest.TestCase):
    def test_comments_and_white_space_do_not_count(self):
        for same in (
            "// a comment\n" + CODE,
            CODE.replace(";", ";  // \"it's\"", 1),
            CODE.replace(", ", ",/* two\n lines */\n    "),
        ):
            self.assertEqual(code_of(same), code_of(CODE), same)

    def test_every_other_change_counts(self):
        for other in (
            CODE.replace("1'000", "1'001"),
            CODE.replace("// text", "// test"),
            CODE.replace("raw", "row"),
            CODE.replace("'\"'", "'!'"),
            CODE.replace("f(", "g("),
            CODE + "// the end\nint b;",
        ):
            self.assertNotEqual(code_of(other), code_of(CODE), other)


if __name__ == "__main__":
    unittest.main()
